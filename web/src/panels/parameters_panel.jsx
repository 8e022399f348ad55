// Control sets, their objects and their parameters, with unit and range; sliders where the run can be asked to change.
import { useEffect, useMemo, useRef, useState } from 'preact/hooks';
import { number, useSession } from '../watching.js';

const finite = (value, otherwise) => (Number.isFinite(value) ? value : otherwise);

// The unit stands beside, so the label does without it: "kp_Nm_per_rad" is "kp". The tooltip has the name.
const unit_suffix = /(_(Nms|Nm|N|rads|rad|deg|ms|us|m|s|Hz|kg|C|W|J|V|A)\d?)+(_per(_(Nms|Nm|N|rads|rad|deg|m|s|Hz|kg|C|W|J|V|A)\d?)+)*$|_per_s\d?$/;
const short = (label, unit) => (unit && unit !== '1' && label.replace(unit_suffix, '')) || label;

const bound = (value, otherwise) => (Number.isFinite(value ?? NaN) ? number(value, 3) : otherwise);
const range_text = (p) => `${bound(p.min, '−∞')}…${bound(p.max, '∞')}`;

// A range without an end gets one that holds the value.
function slider_range(p, value) {
  const reach = 4 * Math.max(Math.abs(value), Math.abs(p.initial), 1);
  return [finite(p.min ?? NaN, -reach), finite(p.max ?? NaN, reach)];
}

function Parameter({ p, value, writable, change, label }) {
  const [low, high] = slider_range(p, value);
  const [held, hold] = useState(null); // what the hand asks for, until the run has it
  const shown = held ?? value;
  useEffect(() => {
    if (held === null) return undefined;
    const timer = setTimeout(() => hold(null), 700);
    return () => clearTimeout(timer);
  }, [held, value]);
  const ask = (next) => {
    if (!Number.isFinite(next)) return;
    hold(next);
    change(p.name, next);
  };
  const moved = Math.abs(value - p.value) > 1e-9 * Math.max(1, Math.abs(p.value));
  return (
    <div class={moved ? 'parameter moved' : 'parameter'} title={`${p.name}\n${p.doc}\n${range_text(p)} ${p.unit}`} data-parameter={p.name}>
      <span class="name">{short(label, p.unit)}</span>
      <input type="range" aria-label={p.name} min={low} max={high} step={(high - low) / 500} value={shown} disabled={!writable} onInput={(event) => ask(Number(event.target.value))} />
      <input type="number" aria-label={`${p.name}, number`} step="any" value={Number(number(shown, 6))} disabled={!writable} onChange={(event) => ask(Number(event.target.value))} />
      <small><i>{range_text(p)}</i> {p.unit}</small>
      <button class="back" title={`Back to ${number(p.value)}`} disabled={!writable || !moved} onClick={() => ask(p.value)}>↺</button>
    </div>
  );
}

// "l_knee.kp_Nm_per_rad" stands under l_knee.
function parts_of(parameters, strip) {
  const parts = new Map();
  for (const p of parameters) {
    const label = p.name.startsWith(strip) ? p.name.slice(strip.length) : p.name;
    const dot = label.lastIndexOf('.');
    const part = dot < 0 ? '' : label.slice(0, dot);
    if (!parts.has(part)) parts.set(part, []);
    parts.get(part).push([label.slice(dot + 1), p]);
  }
  return [...parts];
}

function Group({ title, note, parameters, open, toggle, session, change, writable, strip }) {
  return (
    <div class="group">
      <button class="topic" aria-expanded={open} onClick={toggle}>{title}{note && <em>{note}</em>}<span>{parameters.length}</span></button>
      {open && parts_of(parameters, strip).map(([part, own]) => (
        <div key={part}>
          {part && <h4>{part}</h4>}
          {own.map(([label, p]) => <Parameter key={p.name} {...{ p, label, change, writable }} value={session.parameters.get(p.name) ?? p.value} />)}
        </div>
      ))}
    </div>
  );
}

function groups_of(description) {
  if (!description) return [];
  const groups = description.objects.map((object) => ({ title: object.name, note: object.type, strip: `${object.name}.`, parameters: description.parameters.filter((p) => p.name.startsWith(`${object.name}.`)) }));
  const taken = new Set(groups.flatMap((group) => group.parameters));
  const rest = new Map();
  for (const p of description.parameters) {
    if (taken.has(p)) continue;
    const owner = p.name.split('.')[0];
    if (!rest.has(owner)) rest.set(owner, []);
    rest.get(owner).push(p);
  }
  for (const [owner, parameters] of rest) groups.push({ title: owner, note: '', strip: `${owner}.`, parameters });
  for (const behavior of description.behaviors) {
    const parameters = behavior.parameters.map((p) => ({ ...p, name: `${behavior.name}.${p.name}` }));
    groups.push({ title: behavior.name, note: 'behavior', strip: `${behavior.name}.`, parameters });
  }
  return groups.filter((group) => group.parameters.length > 0);
}

function Sets({ session }) {
  const active = session.value('engine.control_sets');
  return (
    <p class="sets">
      {session.description.sets.map((set, i) => {
        const on = Number.isFinite(active) ? (active >> i) % 2 === 1 : set.initial;
        return <span key={set.name} class={on ? 'set on' : 'set'} title={`Objects: ${set.objects.join(', ')}`}>{set.name}</span>;
      })}
    </p>
  );
}

export function ParametersPanel({ session }) {
  useSession(session, 5);
  const [words, set_words] = useState('');
  const [open, set_open] = useState(() => new Set());
  const undo = useRef([]);
  const groups = useMemo(() => groups_of(session.description), [session.description]);
  const writable = Boolean(session.remote?.writes);
  if (!session.description) return <p class="hint">This record does not describe its parameters.</p>;
  const change = (name, value) => {
    const last = undo.current[undo.current.length - 1];
    if (last?.name !== name || performance.now() - last.at > 800) {
      const of = groups.flatMap((group) => group.parameters).find((p) => p.name === name);
      undo.current.push({ name, value: session.parameters.get(name) ?? of.value, at: performance.now() });
    } else last.at = performance.now();
    session.remote.set_parameter(name, value);
  };
  const take_back = () => {
    const last = undo.current.pop();
    if (last) session.remote.set_parameter(last.name, last.value);
  };
  const save = async () => {
    const answer = await session.remote.command('save');
    if (answer.done) session.remote.say(answer.text);
  };
  const wanted = words.toLowerCase().split(/\s+/).filter(Boolean);
  const fits = (p) => wanted.every((word) => p.name.toLowerCase().includes(word));
  const toggle = (title) => {
    const next = new Set(open);
    if (!next.delete(title)) next.add(title);
    set_open(next);
  };
  return (
    <div class="parameters">
      <h3>Control sets</h3>
      <Sets session={session} />
      <div class="row">
        <input type="search" placeholder="Find a parameter" value={words} onInput={(event) => set_words(event.target.value)} />
        <button disabled={!writable || undo.current.length === 0} onClick={take_back}>Undo</button>
        <button disabled={!writable} title="Write what was changed into the robot's configuration" onClick={save}>Save</button>
      </div>
      {!writable && <p class="hint">{session.live ? 'Open the page with the token that kadans printed to change them.' : 'As configured for this run.'}</p>}
      {groups.map((group) => {
        const parameters = group.parameters.filter(fits);
        if (parameters.length === 0) return null;
        const shown = wanted.length > 0 || open.has(group.title);
        return <Group key={group.title} {...group} parameters={parameters} open={shown} toggle={() => toggle(group.title)} {...{ session, change, writable }} />;
      })}
    </div>
  );
}
