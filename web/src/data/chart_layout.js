// Where the states of a chart are drawn. Each state that has others inside is laid out by dagre on its own; around it, it
// is one box. An arrow is laid out where the boxes of its ends lie beside each other, and goes on from their borders to
// the states in them.
import { Graph, layout } from '@dagrejs/dagre';

const text_width = (text, px = 6.6) => Math.max(1, text.length) * px;

// Whole in the card that a transition shows, and in the title of a state.
const label_max = 30;
const name_max = 34;
const short = (label, most) => (label.length > most ? `${label.slice(0, most - 1)}…` : label);

const head = 18; // of a box, for its name

const none = (index) => index === null || index === undefined;

// From a point towards the middle of a box: where its border is met.
function border(box, from) {
  const [dx, dy] = [from.x - box.x, from.y - box.y];
  const share = Math.min(1, box.width / 2 / Math.max(Math.abs(dx), 1e-6), box.height / 2 / Math.max(Math.abs(dy), 1e-6));
  return { x: box.x + dx * share, y: box.y + dy * share };
}

class Layout {
  // As dagre's rankdir: how the outermost states follow each other, how those inside of others do, how regions lie.
  constructor({ states, transitions }, outer, inner, beside) {
    Object.assign(this, { states, outer, inner, beside });
    this.children = states.map(() => []);
    states.forEach((state, i) => i > 0 && this.children[state.parent].push(i));
    this.edges = states.map(() => []); // by the state in which they are laid out
    transitions.forEach((transition) => this.add_edge(transition.source, transition.target, { transition, label: short(transition.label, label_max), key: `t${transition.number}` }));
    states.forEach((state, i) => {
      if (state.kind === 'history' && !none(state.initial)) this.add_edge(i, state.initial, { label: '', key: `default${i}` });
    });
  }

  around(index) {
    const all = [];
    for (let i = index; !none(i); i = this.states[i].parent) all.unshift(i);
    return all;
  }

  // What goes from a state into itself comes from its `any` node.
  add_edge(from, to, edge) {
    const [a, b] = [this.around(from), this.around(to)];
    let same = 0;
    while (same < a.length && same < b.length && a[same] === b[same]) ++same;
    const into = same === a.length && from !== to;
    const level = into ? from : a[Math.min(same, a.length - 1, b.length - 1) - 1];
    const [begin, end] = [into ? 'any' : (a[same] ?? from), b[same] ?? to];
    this.edges[level].push({ ...edge, from, to, begin, end });
  }

  node_of(index) {
    const state = this.states[index];
    const history = state.kind === 'history';
    const label = history ? (state.deep ? 'H*' : 'H') : short(state.name, name_max);
    const node = { id: index, label, kind: state.kind, path: state.path };
    if (this.children[index].length === 0) return { ...node, width: history ? 28 : text_width(label, 7.4) + 26, height: history ? 28 : 30 };
    const inner = this.level(index);
    return { ...node, cluster: true, inner, width: Math.max(inner.width, text_width(label, 6.6) + 30), height: inner.height + head };
  }

  // {width, height, nodes, edges} of what is directly or further inside a state, from its upper left corner.
  level(parent) {
    const { kind, initial } = this.states[parent];
    const graph = new Graph({ multigraph: true });
    graph.setGraph({ rankdir: kind === 'parallel' ? this.beside : parent === 0 ? this.outer : this.inner, nodesep: 20, ranksep: 32, edgesep: 12, marginx: 12, marginy: 8 });
    for (const child of this.children[parent]) graph.setNode(String(child), this.node_of(child));
    if (kind !== 'parallel' && !none(initial)) {
      graph.setNode('start', { id: `start${parent}`, width: 10, height: 10, start: true, label: '' });
      const first = this.around(initial)[this.around(parent).length];
      graph.setEdge('start', String(first), { width: 0, height: 0, key: `start${parent}`, from: initial, to: initial, begin: 'start', end: first }, 'start');
    }
    const edges = this.edges[parent];
    if (edges.some((edge) => edge.begin === 'any')) graph.setNode('any', { id: `any${parent}`, label: 'any state', width: 76, height: 24, any: true });
    for (const edge of edges) graph.setEdge(String(edge.begin), String(edge.end), { ...edge, width: text_width(edge.label, 5.9), height: edge.label ? 14 : 0, labelpos: 'c' }, edge.key);
    layout(graph);
    const { width = 40, height = 20 } = graph.graph();
    const nodes = graph.nodes().map((id) => graph.node(id));
    const all = { width, height, nodes: [...nodes], edges: graph.edges().map((edge) => graph.edge(edge)) };
    for (const { inner, ...box } of nodes) {
      if (!inner) continue;
      const [dx, dy] = [box.x - inner.width / 2, box.y - box.height / 2 + head];
      all.nodes.push(...inner.nodes.map((node) => ({ ...node, x: node.x + dx, y: node.y + dy })));
      all.edges.push(...inner.edges.map((edge) => ({ ...edge, x: edge.x + dx, y: edge.y + dy, points: edge.points.map((p) => ({ x: p.x + dx, y: p.y + dy })) })));
    }
    return all;
  }

  whole() {
    const all = this.level(0);
    const boxes = new Map(all.nodes.map((node) => [node.id, node]));
    for (const edge of all.edges) {
      if (typeof edge.begin === 'number' && edge.from !== edge.begin) edge.points = [border(boxes.get(edge.from), edge.points[0]), ...edge.points];
      if (edge.to !== edge.end) edge.points = [...edge.points, border(boxes.get(edge.to), edge.points.at(-1))];
    }
    return all;
  }
}

// Whichever way is shown largest in a place of this ratio, width to height; the first where they hardly differ.
export function chart_layout(chart, ratio = 1) {
  const scale = ({ width, height }) => Math.min(ratio / width, 1 / height);
  const ways = (asked) => (asked ? ['TB', 'LR'] : ['TB']);
  const nested = chart.states.some((state) => state.parent > 0);
  const parallel = chart.states.some((state) => state.kind === 'parallel');
  let best = null;
  for (const outer of ways(true)) {
    for (const inner of ways(nested)) {
      for (const beside of ways(parallel)) {
        const found = new Layout(chart, outer, inner, beside).whole();
        if (best === null || scale(found) > 1.1 * scale(best)) best = found;
      }
    }
  }
  return best;
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
