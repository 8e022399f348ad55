// Sends an event to the behaviors that play: choose it, fill in its fields as they are declared (k.events).
import { useState } from 'preact/hooks';

// Those that somebody declares, each once.
function events_of(description) {
  const events = new Map();
  for (const behavior of description?.behaviors ?? [])
    for (const event of behavior.events ?? []) if (!events.has(event.name)) events.set(event.name, event);
  return [...events.values()];
}

function Field({ field, value, set }) {
  const range = field.min !== undefined || field.max !== undefined ? ` ${field.min ?? '−∞'}…${field.max ?? '∞'}` : '';
  const about = { 'aria-label': field.name, title: `${field.doc ?? field.name}${range}${field.optional ? ', optional' : ''}` };
  if (field.type === 'flag')
    return (
      <select {...about} value={value} onChange={(event) => set(event.target.value)}>
        <option value="">{field.optional ? '–' : 'false'}</option>
        <option value="true">true</option>
        {field.optional && <option value="false">false</option>}
      </select>
    );
  return <input {...about} type={field.type === 'number' ? 'number' : 'text'} step="any" min={field.min} max={field.max} required={!field.optional} maxLength={256} value={value} onInput={(event) => set(event.target.value)} />;
}

// What is left empty is left out; a flag that must be there is false.
function data_of(event, values) {
  const data = {};
  for (const field of event.fields) {
    const value = values[field.name] ?? '';
    if (field.type === 'flag' && (value !== '' || !field.optional)) data[field.name] = value === 'true';
    else if (value !== '') data[field.name] = field.type === 'number' ? Number(value) : value;
  }
  return data;
}

export function EventForm({ session }) {
  const [chosen, choose] = useState('');
  const [values, set_values] = useState({});
  const events = events_of(session.description);
  if (events.length === 0 || !session.live) return null;
  const event = events.find((one) => one.name === chosen) ?? events[0];
  const send = (submit) => {
    submit.preventDefault();
    session.remote.command('emit', { text: `${event.name} ${JSON.stringify(data_of(event, values))}` });
  };
  return (
    <form class="emit" onSubmit={send}>
      <select aria-label="Event" title={event.doc} value={event.name} onChange={(change) => (choose(change.target.value), set_values({}))}>
        {events.map((one) => <option key={one.name}>{one.name}</option>)}
      </select>
      {event.fields.map((field) => (
        <label key={field.name}>{field.name}<Field field={field} value={values[field.name] ?? ''} set={(value) => set_values({ ...values, [field.name]: value })} /></label>
      ))}
      <button disabled={!session.remote?.writes}>Emit</button>
    </form>
  );
}
