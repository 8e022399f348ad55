// All signals by topic, to be dragged into a plot; Enter or a double click puts one into the newest plot.
import { useMemo, useState } from 'preact/hooks';
import { number, useSession } from '../watching.js';

const drag_type = 'application/x-kadans-signal';
export const dragged_signal = (event) => event.dataTransfer.getData(drag_type) || event.dataTransfer.getData('text/plain');

function Signal({ session, signal, add }) {
  const value = session.value(signal.name);
  const short = signal.name.slice(signal.name.indexOf('.') + 1);
  return (
    <li
      draggable
      tabIndex={0}
      title={`${signal.name}${signal.unit ? `  [${signal.unit}]` : ''}\n${signal.doc}`}
      data-signal={signal.name}
      onDragStart={(event) => {
        event.dataTransfer.setData(drag_type, signal.name);
        event.dataTransfer.setData('text/plain', signal.name);
        event.dataTransfer.effectAllowed = 'copy';
      }}
      onDblClick={() => add(signal.name)}
      onKeyDown={(event) => event.key === 'Enter' && add(signal.name)}
    >
      <span class="name">{short}</span>
      <span class="value">{number(value, 4)}</span>
    </li>
  );
}

export function SignalList({ session, add, search_box }) {
  useSession(session, 5);
  const [words, set_words] = useState('');
  const [open, set_open] = useState(() => new Set());
  const wanted = words.toLowerCase().split(/\s+/).filter(Boolean);
  const topics = useMemo(() => {
    const fits = (signal) => wanted.every((word) => signal.name.toLowerCase().includes(word));
    return [...session.topics.values()]
      .map((topic) => ({ name: topic.name, signals: topic.signals.filter(fits) }))
      .filter((topic) => topic.signals.length > 0);
  }, [session, session.topics.size, words]);
  const toggle = (name) => {
    const next = new Set(open);
    if (!next.delete(name)) next.add(name);
    set_open(next);
  };
  return (
    <section class="signals" aria-label="Signals">
      <input
        ref={search_box}
        type="search"
        placeholder="Find a signal  ( / )"
        value={words}
        onInput={(event) => set_words(event.target.value)}
      />
      <div class="scroll">
        {topics.map((topic) => {
          const shown = wanted.length > 0 || open.has(topic.name);
          return (
            <div key={topic.name}>
              <button class="topic" aria-expanded={shown} onClick={() => toggle(topic.name)}>
                {topic.name.slice(1)}<span>{topic.signals.length}</span>
              </button>
              {shown && <ul>{topic.signals.map((signal) => <Signal key={signal.name} {...{ session, signal, add }} />)}</ul>}
            </div>
          );
        })}
        {session.topics.size === 0 && <p class="hint">No signals yet.</p>}
      </div>
    </section>
  );
}
