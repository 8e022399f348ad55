// Time: play, step, speed, and a bar over the whole run whose bands are the states of its behaviors.
import { useLayoutEffect, useRef } from 'preact/hooks';
import { clock, useSession, useShown } from '../watching.js';

const speeds = [0.1, 0.25, 0.5, 1, 2, 5];

function bands_of(session) {
  const bands = [];
  for (const behavior of new Set(session.transitions.map((entry) => entry.behavior))) {
    const own = session.transitions.filter((entry) => entry.behavior === behavior);
    const states = [...new Set(own.flatMap((entry) => [entry.from, entry.to]))];
    let from = session.start_s;
    let state = own[0].from;
    for (const entry of [...own, { t: session.end_s, to: '' }]) {
      bands.push({ from, to: entry.t, state, tone: states.indexOf(state) % 6 });
      [from, state] = [entry.t, entry.to];
    }
    break; // the first behavior's; the others stand in the log
  }
  return bands;
}

export function ScrubBar({ session, frames }) {
  useSession(session, 8);
  const bar = useRef();
  const head = useRef();
  const shown = useShown(session);
  useLayoutEffect(
    () =>
      frames.add(() => {
        const now = shown.current;
        const span = now.end_s - now.start_s || 1;
        head.current.style.left = `${(100 * (now.cursor_s - now.start_s)) / span}%`;
      }),
    [],
  );
  const span = session.end_s - session.start_s || 1;
  const share = (t) => `${(100 * (Math.max(t, session.start_s) - session.start_s)) / span}%`;
  // By the time that there is now: what was drawn last may be older.
  const seek = (event) => {
    if (event.buttons !== 1) return;
    const box = bar.current.getBoundingClientRect();
    session.seek(session.start_s + ((session.end_s - session.start_s) * (event.clientX - box.left)) / box.width);
    bar.current.setPointerCapture?.(event.pointerId);
  };
  return (
    <footer class="scrub">
      <button class="play" aria-label={session.playing ? 'Pause' : 'Play'} title="Play or pause (space)" onClick={() => session.toggle_play()}>
        {session.playing ? '❚❚' : '▶'}
      </button>
      {session.live ? (
        <button class="newest" aria-pressed={session.following} onClick={() => ((session.following = true), (session.playing = true))}>Live</button>
      ) : (
        <select aria-label="Speed" value={session.speed} onChange={(event) => (session.speed = Number(event.target.value))}>
          {speeds.map((speed) => <option key={speed} value={speed}>{speed}×</option>)}
        </select>
      )}
      <div class="bar" ref={bar} role="slider" tabIndex={0} aria-label="Time" aria-valuemin={session.start_s} aria-valuemax={session.end_s} aria-valuenow={session.cursor_s} onPointerDown={seek} onPointerMove={seek}>
        {bands_of(session).map((band, i) => (
          <div key={i} class={`band tone${band.tone}`} style={{ left: share(band.from), width: `calc(${share(band.to)} - ${share(band.from)})` }} title={band.state}>
            <span>{band.state}</span>
          </div>
        ))}
        <div class="head" ref={head} />
        {session.loading > 0 && <div class="loading" style={{ width: `${100 * session.loading}%` }} />}
      </div>
      <output>{clock(session.cursor_s)}<small> / {clock(session.end_s)}</small></output>
    </footer>
  );
}
