// The charts of the behaviors with the active path lit, and below them every transition of the run.
import { useEffect, useMemo, useRef, useState } from 'preact/hooks';
import { active_states, time_in_state } from '../data/active_states.js';
import { chart_layout, path_of } from '../data/chart_layout.js';
import { clock, useSession } from '../watching.js';
import { EventForm } from './event_form.jsx';

const least_scale = 0.72;

function State({ node, active }) {
  const [x, y] = [node.x - node.width / 2, node.y - node.height / 2];
  if (node.start) return <circle class="dot" cx={node.x} cy={node.y} r="4" />;
  const kind = `${node.cluster ? 'cluster' : 'state'}${node.any ? ' any' : ''}${active ? ' active' : ''}`;
  return (
    <g class={kind} data-state={node.label}>
      <rect x={x} y={y} width={node.width} height={node.height} rx={node.cluster ? 10 : 8} />
      <text x={node.x} y={node.cluster ? y + 14 : node.y + 4}>{node.label}</text>
    </g>
  );
}

function Edge({ edge, lit }) {
  return (
    <g class={lit ? 'edge lit' : 'edge'}>
      <path d={path_of(edge.points)} marker-end={lit ? 'url(#tip-lit)' : 'url(#tip)'} />
      {edge.label && <text x={edge.x} y={edge.y + 3}>{edge.label}<title>{edge.transition?.label}</title></text>}
    </g>
  );
}

const Tip = ({ id }) => (
  <marker id={id} viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7" orient="auto-start-reverse"><path d="M0,0.6 L7.4,4 L0,7.4 z" /></marker>
);

function Chart({ session, behavior }) {
  const drawing = useMemo(() => chart_layout(behavior.chart), [behavior]);
  const t = session.cursor_s;
  const active = active_states(session, behavior, t);
  const last = session.last_transitions(t).get(behavior.name);
  const { states } = behavior.chart;
  const lit = (edge) => last && edge.transition && states[edge.transition.target].path === last.to && (edge.transition.source === 0 || states[edge.transition.source].path === last.from);
  const clusters_first = [...drawing.nodes].sort((a, b) => Number(Boolean(b.cluster)) - Number(Boolean(a.cluster)));
  return (
    <svg class="chart" viewBox={`0 0 ${drawing.width} ${drawing.height}`} style={{ maxWidth: `${drawing.width * 1.15}px`, minWidth: `${drawing.width * least_scale}px` }} role="img" aria-label={`States of ${behavior.name}`}>
      <defs><Tip id="tip" /><Tip id="tip-lit" /></defs>
      {clusters_first.filter((node) => node.cluster).map((node) => <State key={node.id} node={node} active={active.has(node.id)} />)}
      {drawing.edges.map((edge) => <Edge key={edge.key} edge={edge} lit={lit(edge)} />)}
      {clusters_first.filter((node) => !node.cluster).map((node) => <State key={node.id} node={node} active={active.has(node.id)} />)}
    </svg>
  );
}

function Now({ session, behavior }) {
  const active = active_states(session, behavior, session.cursor_s);
  const innermost = Math.max(-1, ...active);
  const path = innermost >= 0 ? behavior.chart.states[innermost].path : '';
  return (
    <p class="now-state">
      <b>{behavior.name}</b>
      <span class="path">{path || 'not begun'}</span>
      {path && <time title="Time in this state">for {time_in_state(session, behavior, session.cursor_s).toFixed(1)} s</time>}
    </p>
  );
}

// Never smaller than can be read: a chart that is larger than its place scrolls, and the active state stays in sight.
function ChartBox({ session, behavior }) {
  const box = useRef();
  const active = session.transitions.findLast((entry) => entry.behavior === behavior.name && entry.t <= session.cursor_s)?.to;
  useEffect(() => {
    const outer = box.current?.getBoundingClientRect();
    const state = box.current?.querySelector('.state.active')?.getBoundingClientRect();
    if (!state || (outer.width >= box.current.scrollWidth && outer.height >= box.current.scrollHeight)) return;
    box.current.scrollBy({ left: state.x + state.width / 2 - outer.x - outer.width / 2, top: state.y + state.height / 2 - outer.y - outer.height / 2 });
  }, [active, behavior]);
  return <div class="chart-box" ref={box} tabIndex={0} aria-label="Chart"><Chart {...{ session, behavior }} /></div>;
}

export function TransitionLog({ session }) {
  const list = useRef();
  const at = session.transitions.filter((entry) => entry.t <= session.cursor_s).length - 1;
  useEffect(() => {
    const row = list.current?.children[Math.max(0, at)];
    if (row) list.current.scrollTop = Math.max(0, row.offsetTop - list.current.offsetTop - list.current.clientHeight / 2);
  }, [at]);
  return (
    <ol class="transitions" ref={list}>
      {session.transitions.map((entry, i) => (
        <li key={i} class={i === at ? 'current' : i > at ? 'ahead' : ''}>
          <button onClick={() => session.seek(entry.t)}>
            <time>{entry.t.toFixed(2)}</time>
            <span>{entry.from || '·'} <i>→</i> <b>{entry.to}</b></span>
            <small>{entry.why}</small>
          </button>
        </li>
      ))}
      {session.transitions.length === 0 && <li class="hint">No transition yet.</li>}
    </ol>
  );
}

export function BehaviorPanel({ session }) {
  useSession(session, 15);
  const behaviors = session.description?.behaviors ?? [];
  const [chosen, choose] = useState(0);
  const count = useRef(0);
  useEffect(() => {
    if (count.current > 0 && behaviors.length > count.current) choose(behaviors.length - 1); // what plays now came last
    count.current = behaviors.length;
  }, [behaviors.length]);
  const behavior = behaviors[Math.min(chosen, behaviors.length - 1)];
  return (
    <div class="behavior">
      {behaviors.length > 1 && (
        <nav class="chips">
          {behaviors.map((other, i) => <button key={i} aria-pressed={i === chosen} onClick={() => choose(i)}>{other.name}</button>)}
        </nav>
      )}
      {behavior ? <><Now {...{ session, behavior }} /><ChartBox {...{ session, behavior }} /></> : <p class="hint">{session.description ? 'No behavior plays.' : 'No chart yet.'}</p>}
      <EventForm session={session} />
      <h3>Transitions</h3>
      <TransitionLog session={session} />
    </div>
  );
}
