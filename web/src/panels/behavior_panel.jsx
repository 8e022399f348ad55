// The charts of the behaviors with the active path lit, and below them every transition of the run.
import { useEffect, useRef, useState } from 'preact/hooks';
import { active_paths, active_since } from '../data/active_states.js';
import { useSession } from '../watching.js';
import { Chart } from './chart.jsx';

// The paths of all active states, a line each.
function Now({ session, behavior }) {
  const paths = active_paths(session, behavior, session.cursor_s);
  const for_s = (path) => (session.cursor_s - active_since(session, behavior, path, session.cursor_s)).toFixed(1);
  return (
    <div class="now-state">
      <b>{behavior.name}</b>
      <ul>
        {paths.map((path) => <li key={path}><span class="path" title={path}>{path}</span><time title="Time in this state">for {for_s(path)} s</time></li>)}
        {paths.length === 0 && <li class="muted">{session.last_transitions().has(behavior.name) ? 'over' : 'not begun'}</li>}
      </ul>
    </div>
  );
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
      {behavior ? <><Now {...{ session, behavior }} /><Chart {...{ session, behavior }} /></> : <p class="hint">{session.description ? 'No behavior plays.' : 'No chart yet.'}</p>}
      <h3>Transitions</h3>
      <TransitionLog session={session} />
    </div>
  );
}
