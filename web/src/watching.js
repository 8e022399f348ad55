// How panels follow a session: at a modest rate while time goes on, at once when something else changed. And what the
// frames of the screen may see of a panel: only what the page shows already, for frames come between a render and its
// effects, too.
import { useEffect, useLayoutEffect, useRef, useState } from 'preact/hooks';

// A value of the newest render that the page shows, for whoever draws or listens outside of renders.
export function useShown(value) {
  const shown = useRef(value);
  useLayoutEffect(() => {
    shown.current = value;
  });
  return shown;
}

export function useSession(session, hertz = 10) {
  const [, draw] = useState(0);
  useEffect(() => {
    let seen = NaN;
    let version = -1;
    const timer = setInterval(() => {
      if (session.cursor_s === seen && session.version === version) return;
      [seen, version] = [session.cursor_s, session.version];
      draw((n) => n + 1);
    }, 1000 / hertz);
    return () => clearInterval(timer);
  }, [session, hertz]);
}

export const number = (value, digits = 4) => {
  if (!Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) return value.toExponential(2);
  return String(Number(value.toPrecision(digits)));
};

export const clock = (t) => (t < 0 ? '-' : '') + `${Math.abs(t).toFixed(2)} s`;
