// Where the states of a chart are drawn: laid out by dagre, children inside their parents.
import { Graph, layout } from '@dagrejs/dagre';

const text_width = (text, px = 6.6) => Math.max(1, text.length) * px;

// Whole in the tooltip.
const label_max = 26;
const short = (label) => (label.length > label_max ? `${label.slice(0, label_max - 1)}…` : label);

// Arrows go between leaves; one of a compound state begins at its first leaf.
function leaf_of(states, index, parents) {
  while (parents.has(index)) {
    const initial = states[index].initial;
    index = initial ?? states.findIndex((state) => state.parent === index);
  }
  return index;
}

export function chart_layout({ states, transitions }) {
  const graph = new Graph({ compound: true, multigraph: true });
  graph.setGraph({ rankdir: 'TB', nodesep: 26, ranksep: 34, edgesep: 14, marginx: 8, marginy: 8 });
  graph.setDefaultEdgeLabel(() => ({}));
  const parents = new Set(states.map((state) => state.parent).filter((parent) => parent !== null));
  states.forEach((state, i) => {
    if (i === 0) return;
    const label = state.kind === 'history' ? 'H' : state.name;
    graph.setNode(i, parents.has(i) ? { label, cluster: true } : { label, width: text_width(label, 7.4) + 26, height: 30 });
  });
  states.forEach((state, i) => {
    if (i > 0 && state.parent > 0) graph.setParent(i, state.parent);
  });
  const first = states[0]?.initial;
  if (first !== null && first !== undefined) {
    graph.setNode('start', { width: 10, height: 10, start: true, label: '' });
    graph.setEdge('start', leaf_of(states, first, parents), { width: 0, height: 0 }, 'start');
  }
  const any = transitions.some((transition) => transition.source === 0);
  if (any) graph.setNode('any', { label: 'any state', width: 82, height: 24, any: true });
  transitions.forEach((transition, i) => {
    const source = transition.source === 0 ? 'any' : leaf_of(states, transition.source, parents);
    const target = leaf_of(states, transition.target, parents);
    const label = short(transition.label);
    graph.setEdge(source, target, { label, width: text_width(label, 5.9), height: label ? 14 : 0, labelpos: 'c', transition }, `t${i}`);
  });
  layout(graph);
  const nodes = graph.nodes().map((id) => ({ id: Number.isNaN(Number(id)) ? id : Number(id), ...graph.node(id) }));
  const edges = graph.edges().map((edge) => ({ ...graph.edge(edge), key: edge.name }));
  const { width, height } = graph.graph();
  return { nodes, edges, width, height };
}

// A smooth line through dagre's points.
export function path_of(points) {
  if (points.length < 3) return points.map((p, i) => `${i ? 'L' : 'M'}${p.x},${p.y}`).join('');
  let path = `M${points[0].x},${points[0].y}`;
  for (let i = 1; i + 1 < points.length; ++i) {
    const last = i + 2 === points.length;
    const end = last ? points[i + 1] : { x: (points[i].x + points[i + 1].x) / 2, y: (points[i].y + points[i + 1].y) / 2 };
    path += `Q${points[i].x},${points[i].y} ${end.x},${end.y}`;
  }
  return path;
}
