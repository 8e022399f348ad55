// Where the states of a chart are drawn. Each state that has others inside is laid out by dagre on its own; around it, it
// is one box. An arrow is laid out where the boxes of its ends lie beside each other, and goes on from their borders to
// the states in them. One with several targets leads to a bar, from which a line goes to each of them; an action alone is
// a line of text in the box of its state.
import { Graph, layout } from '@dagrejs/dagre';

const text_width = (text, px = 6.6) => Math.max(1, text.length) * px;

// Whole in the card that a transition shows, and in the title of a state.
const label_max = 30;
const name_max = 34;
const short = (label, most) => (label.length > most ? `${label.slice(0, most - 1)}…` : label);

const head = 18; // of a box, for its name
export const line_height = 14; // of an action alone

// The lists of what has the same key, by the key.
export function grouped(all, key) {
  const groups = new Map();
  all.forEach((one, i) => groups.set(key(one, i), [...(groups.get(key(one, i)) ?? []), one]));
  return groups;
}

const none = (index) => index === null || index === undefined;

// From a point towards the middle of a box: where its border is met.
function border(box, from) {
  const [dx, dy] = [from.x - box.x, from.y - box.y];
  const share = Math.min(1, box.width / 2 / Math.max(Math.abs(dx), 1e-6), box.height / 2 / Math.max(Math.abs(dy), 1e-6));
  return { x: box.x + dx * share, y: box.y + dy * share };
}

function label_of({ label, internal }) {
  const text = short(label, label_max);
  return internal ? `${text} {local}`.trimStart() : text;
}

// An action alone, as UML writes it.
function line_of(transition) {
  const text = `${transition.always ? '«always» ' : ''}${transition.label}`;
  return { transition, text: `${short(text, label_max)} / action`.trimStart() };
}

// {width, height} of a box with these lines below its name.
const box_of = (width, height, lines) => ({
  lines,
  width: Math.max(width, ...lines.map(({ text }) => text_width(text, 5.6) + 20)),
  height: height + (lines.length > 0 ? lines.length * line_height + 4 : 0),
});

// Where they begin in a node of the drawing.
export const lines_from = (node) => (node.cluster ? node.y - node.height / 2 + head : node.y + node.height / 2 - (node.lines?.length > 0 ? node.lines.length * line_height + 4 : 0));

// What dagre has laid out as it is drawn: the loops of a box beside it or below it, where their label is.
function drawn(edge, box) {
  if (edge.back) return { ...edge, points: edge.points.slice().reverse() };
  if (edge.begin !== edge.end) return edge;
  const { x, y, width, height } = box;
  const [by_x, by_y] = [Math.min(width / 4, 12), Math.min(height / 4, 12)];
  const beside = [[x + width / 2, y - by_y], [edge.x, y - by_y], [edge.x, y + by_y], [x + width / 2, y + by_y]];
  const below = [[x - by_x, y + height / 2], [x - by_x, edge.y], [x + by_x, edge.y], [x + by_x, y + height / 2]];
  return { ...edge, points: (edge.x > x + width / 2 ? beside : below).map(([px, py]) => ({ x: px, y: py })) };
}

class Layout {
  // As dagre's rankdir: how the outermost states follow each other, how those inside of others do, how regions lie.
  constructor({ states, transitions }, outer, inner, beside) {
    Object.assign(this, { states, outer, inner, beside });
    this.children = states.map(() => []);
    states.forEach((state, i) => i > 0 && this.children[state.parent].push(i));
    this.edges = states.map(() => []); // by the state in which they are laid out
    this.forks = states.map(() => []);
    this.lines = states.map(() => []);
    // An entry for each target.
    for (const [number, all] of grouped(transitions, ({ number }, i) => number ?? i)) {
      const [transition] = all;
      if (none(transition.target)) this.lines[transition.source].push(line_of(transition));
      else this.add_edge(transition.source, all.map(({ target }) => target), { transition, label: label_of(transition), key: `t${number}` });
    }
    states.forEach((state, i) => {
      if (state.kind === 'history' && !none(state.initial)) this.add_edge(i, [state.initial], { label: '', key: `default${i}` });
    });
  }

  around(index) {
    const all = [];
    for (let i = index; !none(i); i = this.states[i].parent) all.unshift(i);
    return all;
  }

  // What goes from a state into those in it comes from its `any` node.
  add_edge(from, targets, edge) {
    const [a, ...ways] = [from, ...targets].map((index) => this.around(index));
    let same = 0;
    while (same < a.length && ways.every((way) => way[same] === a[same])) ++same;
    const into = same === a.length && targets[0] !== from;
    const level = into ? from : a[Math.min(same, a.length - 1, ...ways.map((way) => way.length - 1)) - 1];
    const depth = this.around(level).length;
    const begin = into ? 'any' : a[depth];
    const end = (i) => ways[i][depth];
    if (targets.length === 1) return this.edges[level].push({ ...edge, from, to: targets[0], begin, end: end(0) });
    const fork = `fork${edge.transition.number}`;
    const back = begin > end(0); // laid out the other way round: the bar lies between both, not behind
    this.forks[level].push({ id: fork, fork: edge.key });
    this.edges[level].push({ ...edge, back, group: edge.key, from, to: fork, begin, end: fork });
    return targets.forEach((to, i) => this.edges[level].push({ ...edge, back, label: '', group: edge.key, key: `${edge.key} ${i}`, from: fork, to, begin: fork, end: end(i) }));
  }

  node_of(index) {
    const state = this.states[index];
    const history = state.kind === 'history';
    const label = history ? (state.deep ? 'H*' : 'H') : short(state.name, name_max);
    const node = { id: index, label, kind: state.kind, path: state.path };
    const lines = this.lines[index];
    if (history) return { ...node, ...box_of(28, 28, []) };
    if (this.children[index].length === 0) return { ...node, ...box_of(text_width(label, 7.4) + 26, 30, lines) };
    const inner = this.level(index);
    return { ...node, cluster: true, inner, ...box_of(Math.max(inner.width, text_width(label, 6.6) + 30), inner.height + head, lines) };
  }

  // {width, height, nodes, edges} of what is directly or further inside a state, from its upper left corner.
  level(parent) {
    const { kind, initial } = this.states[parent];
    const graph = new Graph({ multigraph: true });
    const rankdir = kind === 'parallel' ? this.beside : parent === 0 ? this.outer : this.inner;
    graph.setGraph({ rankdir, nodesep: 20, ranksep: 32, edgesep: 12, marginx: 12, marginy: 8 });
    for (const child of this.children[parent]) graph.setNode(String(child), this.node_of(child));
    if (kind !== 'parallel' && !none(initial)) {
      graph.setNode('start', { id: `start${parent}`, width: 10, height: 10, start: true, label: '' });
      const first = this.around(initial)[this.around(parent).length];
      graph.setEdge('start', String(first), { width: 0, height: 0, key: `start${parent}`, from: initial, to: initial, begin: 'start', end: first }, 'start');
    }
    const edges = this.edges[parent];
    const own = parent === 0 ? this.lines[0] : []; // the outermost state has no box
    if (own.length > 0 || edges.some((edge) => edge.begin === 'any')) graph.setNode('any', { id: `any${parent}`, label: 'any state', ...box_of(76, 24, own), any: true });
    for (const fork of this.forks[parent]) graph.setNode(fork.id, { ...fork, ...(rankdir === 'TB' ? { width: 44, height: 4 } : { width: 4, height: 44 }) });
    for (const edge of edges) {
      const [v, w] = edge.back ? [edge.end, edge.begin] : [edge.begin, edge.end];
      graph.setEdge(String(v), String(w), { ...edge, width: text_width(edge.label, 5.9), height: edge.label ? 14 : 0, labelpos: 'c' }, edge.key);
    }
    layout(graph);
    const { width = 40, height = 20 } = graph.graph();
    const nodes = graph.nodes().map((id) => graph.node(id));
    const all = { width, height, nodes: [...nodes], edges: graph.edges().map((id) => drawn(graph.edge(id), graph.node(id.v))) };
    for (const { inner, ...box } of nodes) {
      if (!inner) continue;
      const [dx, dy] = [box.x - inner.width / 2, box.y + box.height / 2 - inner.height];
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
