// The chart of a behavior with its active states lit. It is drawn at a size that can be read, or smaller when all of it
// is asked for; wheel, drag and keys move it, and until a hand has moved it the active states stay in sight.
import { useEffect, useMemo, useRef, useState } from 'preact/hooks';
import { active_since, active_states } from '../data/active_states.js';
import { chart_layout, grouped, line_height, lines_from, path_of } from '../data/chart_layout.js';
import { TransitionCard } from './transition_card.jsx';

const [readable, least, most] = [0.78, 0.08, 3];

// A state's name stands in the middle of its box, or at its top when it has others or actions below.
function State({ node, active }) {
  const [x, y] = [node.x - node.width / 2, node.y - node.height / 2];
  if (node.start) return <circle class="dot" cx={node.x} cy={node.y} r="4" />;
  const round = node.kind === 'history';
  const kind = `${node.cluster ? 'cluster' : 'state'} ${node.kind ?? ''}${node.any ? ' any' : ''}${active ? ' active' : ''}`;
  return (
    <g class={kind} data-state={node.label} data-path={node.path}>
      {round ? <circle cx={node.x} cy={node.y} r="13" /> : <rect x={x} y={y} width={node.width} height={node.height} rx={node.cluster ? 10 : 8} />}
      {node.kind === 'final' && !node.cluster && <rect class="inner" x={x + 3} y={y + 3} width={node.width - 6} height={node.height - 6} rx="6" />}
      <text x={node.x} y={node.cluster ? y + 14 : y + (lines_from(node) - y) / 2 + 4}>{node.label}</text>
      {!node.cluster && node.lines?.length > 0 && <path class="rule" d={`M${x},${lines_from(node)}h${node.width}`} />}
      <title>{node.path}</title>
    </g>
  );
}

// What shows the card of a transition.
const hands = (transition, { show, hide }) => ({ 'data-transition': transition.number, tabindex: -1, onPointerEnter: (event) => show(transition, event), onPointerLeave: hide, onFocus: (event) => show(transition, event), onBlur: hide });

// The arrow of a transition, or its arrows and the bar from which they go.
function Edge({ edges, bar, lit, ...card }) {
  const [{ transition, label, x, y }] = edges;
  const kind = `edge${lit ? ' lit' : ''}${transition?.always ? ' always' : ''}`;
  return (
    <g class={kind} {...(transition ? hands(transition, card) : {})}>
      {edges.map(({ key, points }) => <path key={key} class="line" d={path_of(points)} marker-end={lit ? 'url(#tip-lit)' : 'url(#tip)'} />)}
      {transition && edges.map(({ key, points }) => <path key={key} class="reach" d={path_of(points)} />)}
      {bar && <rect class="fork" x={bar.x - bar.width / 2} y={bar.y - bar.height / 2} width={bar.width} height={bar.height} rx="2" />}
      {label && <text x={x} y={y + 3}>{label}</text>}
    </g>
  );
}

// The actions alone of a state.
function Lines({ node, active, ...card }) {
  const x = node.x - node.width / 2;
  return node.lines.map(({ transition, text }, i) => {
    const y = lines_from(node) + 2 + i * line_height;
    return (
      <g key={transition.number} class={`edge alone${active && !node.cluster ? ' inside' : ''}`} {...hands(transition, card)}>
        <rect class="reach" x={x + 3} y={y} width={node.width - 6} height={line_height} />
        <text x={x + 10} y={y + 10}>{text}</text>
      </g>
    );
  });
}

const Tip = ({ id }) => (
  <marker id={id} viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7" orient="auto-start-reverse"><path d="M0,0.6 L7.4,4 L0,7.4 z" /></marker>
);

// The number of the transition that came last; of several with the same ends: all.
function lit_numbers({ states, transitions }, last) {
  const found = transitions.filter(({ source, target }) => last && states[target]?.path === last.to && `${last.from}.`.startsWith(source === 0 ? '' : `${states[source].path}.`));
  const inner = Math.max(...found.map(({ source }) => states[source].path.length));
  return new Set(found.filter(({ source }) => states[source].path.length === inner).map(({ number }) => number));
}

function Drawing({ session, behavior, drawing, active, ...card }) {
  const lit = lit_numbers(behavior.chart, session.last_transitions(session.cursor_s).get(behavior.name));
  // What is around others lies below them.
  const clusters = drawing.nodes.filter((node) => node.cluster).sort((a, b) => a.id - b.id);
  const groups = grouped(drawing.edges, (edge) => edge.group ?? edge.key);
  const bars = new Map(drawing.nodes.filter((node) => node.fork).map((node) => [node.fork, node]));
  return (
    <>
      {clusters.map((node) => <State key={node.id} node={node} active={active.has(node.id)} />)}
      {[...groups].map(([key, edges]) => <Edge key={key} edges={edges} bar={bars.get(key)} lit={lit.has(edges[0].transition?.number)} {...card} />)}
      {drawing.nodes.filter((node) => !node.cluster && !node.fork).map((node) => <State key={node.id} node={node} active={active.has(node.id)} />)}
      {drawing.nodes.filter((node) => node.lines?.length > 0).map((node) => <Lines key={node.id} node={node} active={active.has(node.id)} {...card} />)}
    </>
  );
}

function useSize(box) {
  const [size, set_size] = useState({ width: 384, height: 340 });
  useEffect(() => {
    const watch = new ResizeObserver(([{ contentRect }]) => set_size({ width: Math.max(contentRect.width, 1), height: Math.max(contentRect.height, 1) }));
    watch.observe(box.current);
    return () => watch.disconnect();
  }, []);
  return size;
}

const whole = (drawing, size) => Math.min(1.15, size.width / drawing.width, size.height / drawing.height);
const bound = (scale) => Math.min(most, Math.max(least, scale));

// The place that shows these nodes: what fits lies in the middle, else their middle does.
function place_for(nodes, drawing, size, scale) {
  // Too far from each other to be seen together: the first, which is the newest.
  const span = (axis, side) => Math.max(...nodes.map((node) => node[axis] + node[side] / 2)) - Math.min(...nodes.map((node) => node[axis] - node[side] / 2));
  if (nodes.length > 1 && (span('x', 'width') * scale > size.width || span('y', 'height') * scale > size.height)) return place_for(nodes.slice(0, 1), drawing, size, scale);
  const axis = (length, room, low, high) => {
    if (length * scale <= room) return (room - length * scale) / 2;
    return Math.min(0, Math.max(room - length * scale, room / 2 - ((low + high) / 2) * scale));
  };
  const xs = nodes.flatMap((node) => [node.x - node.width / 2, node.x + node.width / 2]);
  const ys = nodes.flatMap((node) => [node.y - node.height / 2, node.y + node.height / 2]);
  const [x0, x1, y0, y1] = nodes.length > 0 ? [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)] : [0, 0, 0, 0];
  return { x: axis(drawing.width, size.width, x0, x1), y: axis(drawing.height, size.height, y0, y1), scale };
}

export function Chart({ session, behavior }) {
  const box = useRef();
  const size = useSize(box);
  const [wide, set_wide] = useState(false);
  const shape = Math.round(2 * Math.log2(size.width / size.height)); // a little more room is no reason for another layout
  const drawing = useMemo(() => chart_layout(behavior.chart, size.width / size.height), [behavior, shape]);
  const [hand, set_hand] = useState(null); // {x, y, scale}: where a hand has put it; null: it follows the active states
  const [card, set_card] = useState(null);
  const active = active_states(session, behavior, session.cursor_s);
  const lit = [...active].sort((a, b) => a - b).join();
  const since = (node) => active_since(session, behavior, node.path, session.cursor_s);
  const inner = drawing.nodes.filter((node) => active.has(node.id) && !node.cluster).sort((a, b) => since(b) - since(a));
  const own = useMemo(() => place_for(inner, drawing, size, Math.max(whole(drawing, size), readable)), [drawing, size, lit]);
  const place = hand ?? own;
  useEffect(() => set_hand(null), [behavior, wide]);

  const zoom = (factor, at = { x: size.width / 2, y: size.height / 2 }) => {
    const scale = bound(place.scale * factor);
    set_hand({ scale, x: at.x - ((at.x - place.x) * scale) / place.scale, y: at.y - ((at.y - place.y) * scale) / place.scale });
  };
  const fit = () => set_hand(place_for([], drawing, size, bound(whole(drawing, size))));
  const move = (dx, dy) => set_hand({ ...place, x: place.x + dx, y: place.y + dy });
  const now = useRef();
  now.current = { zoom };
  useEffect(() => {
    const wheel = (event) => {
      const at = box.current.getBoundingClientRect();
      event.preventDefault();
      now.current.zoom(Math.exp(-event.deltaY * (event.deltaMode === 1 ? 0.05 : 0.0015)), { x: event.clientX - at.x, y: event.clientY - at.y });
    };
    box.current.addEventListener('wheel', wheel, { passive: false });
    return () => box.current?.removeEventListener('wheel', wheel);
  }, []);
  const drag = (event) => {
    if (event.buttons !== 1 || (event.movementX === 0 && event.movementY === 0)) return;
    if (!event.currentTarget.hasPointerCapture(event.pointerId)) event.currentTarget.setPointerCapture(event.pointerId);
    move(event.movementX, event.movementY);
  };
  const step = (by) => {
    const edges = [...box.current.querySelectorAll('.edge[tabindex]')];
    edges.at((edges.indexOf(document.activeElement) + by) % edges.length)?.focus({ preventScroll: true });
  };
  const keys = { n: () => step(1), p: () => step(-1), '+': () => zoom(1.25), '-': () => zoom(0.8), 0: fit, ArrowLeft: () => move(40, 0), ArrowRight: () => move(-40, 0), ArrowUp: () => move(0, 40), ArrowDown: () => move(0, -40) };
  const press = (event) => {
    if (event.key === 'Escape' && wide) set_wide(false);
    else if (keys[event.key] && !event.ctrlKey && !event.metaKey) keys[event.key](), event.preventDefault();
    else return;
    event.stopPropagation();
  };
  const show = (transition, { currentTarget }) => set_card({ transition, at: currentTarget.getBoundingClientRect() });
  return (
    <div class={wide ? 'chart-frame wide' : 'chart-frame'} style={wide ? {} : { height: `${Math.min(Math.max(drawing.height * Math.max(whole(drawing, { ...size, height: Infinity }), readable), 180), innerHeight * 0.5)}px` }}>
      <div class="chart-box" ref={box} tabIndex={0} aria-label="Chart" onPointerMove={drag} onDblClick={() => set_hand(null)} onKeyDown={press}>
        <svg class={`chart${place.scale < 0.5 ? ' far' : ''}`} width={size.width} height={size.height} role="img" aria-label={`States of ${behavior.name}`}>
          <defs><Tip id="tip" /><Tip id="tip-lit" /></defs>
          <g transform={`translate(${place.x},${place.y}) scale(${place.scale})`}>
            <Drawing {...{ session, behavior, drawing, active, show }} hide={() => set_card(null)} />
          </g>
        </svg>
      </div>
      <div class="chart-tools" role="group" aria-label="View of the chart">
        <button title="Larger (+, wheel)" aria-label="Larger" onClick={() => zoom(1.25)}>+</button>
        <button title="Smaller (-, wheel)" aria-label="Smaller" onClick={() => zoom(0.8)}>−</button>
        <button title="All of it (0)" onClick={fit}>All</button>
        <button title="Follow the active states again (double click)" aria-pressed={hand === null} onClick={() => set_hand(null)}>Follow</button>
        <button title={wide ? 'Back into the panel (Esc)' : 'Over the whole page'} onClick={() => set_wide(!wide)}>{wide ? 'Close' : 'Wide'}</button>
      </div>
      {card && <TransitionCard key={card.transition.number} {...{ session, behavior, active, ...card }} />}
    </div>
  );
}
