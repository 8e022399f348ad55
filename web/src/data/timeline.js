// The states of a run over time: a row a behavior, in it a lane a region. {behavior, lanes: [{region, bands}]}, a band is
// {from, to, state}; `to` of the last one is null: it goes on.
import { regions_of } from './active_states.js';

const lanes_max = 12; // of one behavior

// Where a behavior ended: the final state that its last transition led to.
function end_of(session, behavior, chart, t) {
  const last = session.last_transitions(t).get(behavior);
  const final = last && chart?.states.some((state) => state.path === last.to && state.kind === 'final');
  return new Map(final ? [['', last.to]] : []);
}

function lanes_of(session, behavior, entries, chart) {
  const lanes = new Map(); // region -> bands
  for (const { t, states } of entries) {
    const now = states.length === 0 ? end_of(session, behavior, chart, t) : chart ? regions_of(chart, states) : new Map([['', states.join(', ')]]);
    for (const [region, bands] of lanes) {
      const last = bands.at(-1);
      if (last.to === null && now.get(region) !== last.state) last.to = t;
    }
    for (const [region, state] of now) {
      if (!lanes.has(region)) lanes.set(region, []);
      const bands = lanes.get(region);
      if (bands.length === 0 || bands.at(-1).to !== null) bands.push({ from: t, to: null, state });
    }
  }
  const order = new Map((chart?.states ?? []).map((state, i) => [state.path, i]));
  const sorted = [...lanes].sort(([a], [b]) => (order.get(a) ?? 0) - (order.get(b) ?? 0));
  return sorted.slice(0, lanes_max).map(([region, bands]) => ({ region, bands }));
}

// A record made before active states were told: the states between the transitions.
function lane_of_transitions(session, behavior) {
  const own = session.transitions.filter((entry) => entry.behavior === behavior);
  const bands = own.map((entry, i) => ({ from: entry.t, to: own[i + 1]?.t ?? null, state: entry.to }));
  return [{ region: '', bands: [{ from: session.start_s, to: own[0].t, state: own[0].from }, ...bands] }];
}

export function timeline(session) {
  const charts = new Map((session.description?.behaviors ?? []).map((behavior) => [behavior.name, behavior.chart]));
  const rows = [...session.active].map(([behavior, entries]) => ({ behavior, lanes: lanes_of(session, behavior, entries, charts.get(behavior)) }));
  const named = new Set(session.transitions.map((entry) => entry.behavior));
  for (const behavior of session.active.size === 0 ? named : []) rows.push({ behavior, lanes: lane_of_transitions(session, behavior) });
  return rows.filter((row) => row.lanes.length > 0);
}
