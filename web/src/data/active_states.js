// Which states of a chart are active at a time: the innermost one as the behavior counts it, with all around it; in
// parallel regions the states that transitions last led to.
export function active_states(session, behavior, t) {
  const { states } = behavior.chart;
  const active = new Set();
  const add = (index) => {
    for (let i = index; i !== null && i !== undefined; i = states[i]?.parent) active.add(i);
  };
  const innermost = session.value(`behavior.${behavior.name}.state`, t);
  if (Number.isFinite(innermost) && states[innermost]) add(innermost);
  const by_path = new Map(states.map((state, i) => [state.path, i]));
  const region = (i) => {
    while (i !== null && i !== undefined && states[i].kind !== 'region') i = states[i].parent;
    return i ?? null;
  };
  const newest = new Map(); // region -> state
  for (const entry of session.transitions) {
    if (entry.t > t) break;
    const index = by_path.get(entry.to);
    if (entry.behavior === behavior.name && index !== undefined) newest.set(region(index), index);
  }
  for (const [of, index] of newest) {
    if (of !== null && active.has(states[of].parent)) add(index);
    if (active.size <= 1) add(index); // it is over: where it ended
  }
  return active;
}

// Seconds since the behavior last changed its state.
export function time_in_state(session, behavior, t) {
  let since = session.start_s;
  for (const entry of session.transitions) {
    if (entry.t > t) break;
    if (entry.behavior === behavior.name) since = entry.t;
  }
  return t - since;
}
