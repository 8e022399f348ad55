// Which states of a behavior are active at a time.

// The index of the newest entry up to t; -1: none.
function newest(entries, t) {
  let [low, high] = [0, entries.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (entries[middle].t <= t) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

// The paths of all innermost active states, in the chart's order. A record made before they were told has the first only.
export function active_paths(session, behavior, t) {
  const entries = session.active.get(behavior.name);
  if (entries) return entries[newest(entries, t)]?.states ?? [];
  const first = behavior.chart.states[session.value(`behavior.${behavior.name}.state`, t)];
  return first?.path ? [first.path] : [];
}

// The numbers of all active states, also of those around others. Of a behavior that is over: where it ended.
export function active_states(session, behavior, t) {
  const { states } = behavior.chart;
  const by_path = new Map(states.map((state, i) => [state.path, i]));
  const active = new Set();
  const add = (path) => {
    for (let i = by_path.get(path) ?? null; i !== null; i = states[i].parent) active.add(i);
  };
  active_paths(session, behavior, t).forEach(add);
  const last = session.last_transitions(t).get(behavior.name);
  if (active.size === 0 && last) add(last.to);
  return active;
}

// Since when this state has been active without a break.
export function active_since(session, behavior, path, t) {
  const entries = session.active.get(behavior.name) ?? [];
  let since = session.start_s;
  for (let i = newest(entries, t); i >= 0 && entries[i].states.includes(path); --i) since = entries[i].t;
  return since;
}

// The innermost active state of each region: its path by the path of the region, "" for the behavior itself.
export function regions_of(chart, paths) {
  const { states } = chart;
  const by_path = new Map(states.map((state, i) => [state.path, i]));
  const regions = new Map();
  for (const path of paths) {
    let inner = by_path.get(path) ?? null;
    if (inner === null) regions.set('', path); // of another version of the chart
    for (let i = inner; i !== null; i = states[i].parent) {
      if (states[i].kind !== 'region') continue;
      regions.set(states[i].path, states[inner].path);
      inner = states[i].parent;
    }
    if (inner !== null) regions.set('', states[inner].path);
  }
  return regions;
}
