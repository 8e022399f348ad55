// What behaviors and the runtime say, line by line.
import { useEffect, useRef, useState } from 'preact/hooks';
import { useSession } from '../watching.js';

const levels = ['', 'debug', 'info', 'warning', 'error', 'fatal'];

export function LogPanel({ session }) {
  useSession(session, 5);
  const [least, set_least] = useState(1);
  const [words, set_words] = useState('');
  const list = useRef();
  const lines = session.log.filter((line) => line.level >= least && `${line.name} ${line.message}`.toLowerCase().includes(words.toLowerCase()));
  const at = lines.filter((line) => line.t <= session.cursor_s).length - 1;
  useEffect(() => {
    const row = list.current?.children[Math.max(0, at)];
    if (row) list.current.scrollTop = Math.max(0, row.offsetTop - list.current.offsetTop - list.current.clientHeight / 2);
  }, [at]);
  return (
    <div class="log">
      <div class="row">
        <input type="search" placeholder="Find in the log" value={words} onInput={(event) => set_words(event.target.value)} />
        <select aria-label="Least severity" value={least} onChange={(event) => set_least(Number(event.target.value))}>
          <option value="1">all</option><option value="3">warnings</option><option value="4">errors</option>
        </select>
      </div>
      <ol class="lines" ref={list}>
        {lines.map((line, i) => (
          <li key={i} class={`${levels[line.level]}${i === at ? ' current' : i > at ? ' ahead' : ''}`}>
            <button onClick={() => session.seek(line.t)}><time>{line.t.toFixed(2)}</time><b>{line.name}</b><span>{line.message}</span></button>
          </li>
        ))}
        {lines.length === 0 && <li class="hint">Nothing was said.</li>}
      </ol>
    </div>
  );
}
