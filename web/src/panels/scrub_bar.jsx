// Time: play, step, speed, and a bar over the whole run: a row a behavior, in it a lane a region, with bands for states.
import { useLayoutEffect, useMemo, useRef } from 'preact/hooks';
import { timeline } from '../data/timeline.js';
import { clock, useSession, useShown } from '../watching.js';

const lanes_shown = 8; // the bar scrolls
const speeds = [0.1, 0.25, 0.5, 1, 2, 5];

// Its colors go by the names of its states, in the order in which they come.
function Lane({ behavior, region, bands, share, end_s, named }) {
  const states = [...new Set(bands.map((band) => band.state))];
  const name = [behavior, region].filter(Boolean).join(' ');
  return (
    <div class="lane" data-behavior={behavior} data-region={region}>
      {bands.map((band, i) => (
        <div key={i} class={`band tone${states.indexOf(band.state) % 6}`} style={{ left: share(band.from), width: `calc(${share(band.to ?? end_s)} - ${share(band.from)})` }} title={`${name}: ${band.state}`}>
          <span>{named && region === '' && <b>{behavior} </b>}{band.state}</span>
        </div>
      ))}
    </div>
  );
}

const bar_height = (rows) => {
  const lanes = rows.reduce((sum, row) => sum + row.lanes.length, 0);
  return `${lanes < 2 ? 26 : 2 + 16 * Math.min(lanes, lanes_shown)}px`;
};

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
  const rows = useMemo(() => timeline(session), [session, session.version]);
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
      <div class="bar" ref={bar} style={{ height: bar_height(rows) }} role="slider" tabIndex={0} aria-label="Time" aria-valuemin={session.start_s} aria-valuemax={session.end_s} aria-valuenow={session.cursor_s} onPointerDown={seek} onPointerMove={seek}>
        {rows.map(({ behavior, lanes }) => lanes.map((lane) => <Lane key={`${behavior} ${lane.region}`} {...{ behavior, share }} {...lane} end_s={session.end_s} named={rows.length > 1} />))}
        <div class="head" ref={head} />
        {session.loading > 0 && <div class="loading" style={{ width: `${100 * session.loading}%` }} />}
      </div>
      <output>{clock(session.cursor_s)}<small> / {clock(session.end_s)}</small></output>
    </footer>
  );
}
