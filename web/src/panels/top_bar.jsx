// What is looked at, how it fares, and what can be asked of a live run.
import { useState } from 'preact/hooks';
import { useSession } from '../watching.js';
import { rungs } from './safety_panel.jsx';

// What to play: a list as `kadans run --play` takes it, in place of what plays now.
function Play({ remote }) {
  const [list, set_list] = useState('');
  const play = async (event) => {
    event.preventDefault();
    const answer = await remote.command('replace', { text: list.trim() });
    if (answer.done) set_list('');
  };
  return (
    <form class="play-list" onSubmit={play}>
      <input type="text" list="plays" aria-label="Behaviors to play" placeholder="play…" title="A behavior, or a list: wave, squat{repeats=2}. In place of what plays." value={list} disabled={!remote.writes} onInput={(event) => set_list(event.target.value)} />
      <datalist id="plays">{remote.plays.map((name) => <option key={name} value={name} />)}</datalist>
      <button disabled={!remote.writes || !list.trim()}>Play</button>
    </form>
  );
}

function Remote({ session }) {
  const { remote } = session;
  const ask = (verb, argument) => remote.command(verb, argument);
  const { paused, held, speed } = remote.state;
  return (
    <div class="remote" role="group" aria-label="Run">
      {remote.verbs.has('hold') && (
        <>
          <button disabled={!remote.writes} title="The simulation's time" onClick={() => ask(held ? 'go' : 'hold')}>{held ? 'Go' : 'Hold'}</button>
          <button disabled={!remote.writes || !held} onClick={() => ask('step', { value: 1 })}>Step</button>
          <select aria-label="Speed of the simulation" value={speed ?? 1} disabled={!remote.writes} onChange={(event) => ask('speed', { value: Number(event.target.value) })}>
            {[0.1, 0.25, 0.5, 1, 2, 5, 10].map((times) => <option key={times} value={times}>{times}×</option>)}
          </select>
        </>
      )}
      {remote.verbs.has('replace') && <Play remote={remote} />}
      {remote.verbs.has('pause') && <button disabled={!remote.writes} onClick={() => ask(paused ? 'resume' : 'pause')}>{paused ? 'Resume' : 'Pause'}</button>}
      {remote.verbs.has('stop') && <button data-verb="stop" disabled={!remote.writes} onClick={() => ask('stop')}>Stop</button>}
      {remote.verbs.has('reload') && <button disabled={!remote.writes} onClick={() => ask('reload')}>Reload</button>}
      {remote.verbs.has('estop') && <button class="estop" disabled={!remote.writes} title="Damp, then off, latched until cleared" onClick={() => ask('estop')}>E-stop</button>}
    </div>
  );
}

export function TopBar({ session, theme, turn, open, help }) {
  useSession(session, 4);
  const level = session.value('safety.level');
  const named = session.live || session.topics.size > 0 || session.loading > 0;
  const pick = () => {
    const input = document.createElement('input');
    Object.assign(input, { type: 'file', accept: '.mcap' });
    input.onchange = () => input.files[0] && open(input.files[0]);
    input.click();
  };
  return (
    <header class="top">
      <h1>Kadans</h1>
      {named && <span class={session.live ? (session.status ? 'badge lost' : 'badge live') : 'badge'}>{session.live ? (session.status || 'live') : 'record'}</span>}
      {named && <span class="title" title={session.title}>{session.title}</span>}
      {session.description && <span class="muted">{session.description.robot.called ?? session.description.robot.name}</span>}
      {!session.live && session.status && <span class="warn">{session.status}</span>}
      {Number.isFinite(level) && <span class={`chip level${level}`} title="Worst rung of robot and joints">{rungs[level]}</span>}
      <span class="grow" />
      {session.remote && <Remote session={session} />}
      <button onClick={pick} title="Or drop a file on the page">Open record…</button>
      <button class="icon" aria-label={theme === 'dark' ? 'Light' : 'Dark'} title="Dark or light (t)" onClick={turn}>{theme === 'dark' ? '☀' : '☾'}</button>
      <button class="icon" aria-label="Keys" title="Keys (?)" onClick={help}>?</button>
      {session.error && session.urdf && <p class="error" role="alert">{session.error}</p>}
    </header>
  );
}
