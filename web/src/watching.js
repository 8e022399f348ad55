// How panels follow a session: at a modest rate while time goes on, at once when something else changed.
import { useEffect, useState } from 'preact/hooks';

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
