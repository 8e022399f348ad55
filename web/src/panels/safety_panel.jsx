// The ladder of safety, rung by rung, for the robot and each joint, and the faults that led there.
import { clock, number, useSession } from '../watching.js';

export const rungs = ['normal', 'limited', 'hold', 'damp', 'off'];

function Ladder({ level }) {
  return (
    <ol class="ladder" aria-label="Ladder">
      {rungs.map((rung, i) => <li key={rung} class={`rung level${i}${i === level ? ' on' : ''}`}>{rung}</li>)}
    </ol>
  );
}

function Joints({ session }) {
  const joints = session.description?.robot.joints ?? [];
  return (
    <table class="joints">
      <thead><tr><th>Joint</th><th>Rung</th><th>Winding</th></tr></thead>
      <tbody>
        {joints.map((joint) => {
          const level = session.value(`safety.${joint}.level`);
          const celsius = session.value(`safety.${joint}.temperature_C`);
          return (
            <tr key={joint}>
              <td>{joint}</td>
              <td><span class={`chip level${level || 0}`}>{rungs[level] ?? '–'}</span></td>
              <td>{Number.isFinite(celsius) ? `${celsius.toFixed(1)} °C` : ''}</td>
            </tr>
          );
        })}
      </tbody>
    </table>
  );
}

// Where no faults are told, their count still says when one came.
function faults_of(session) {
  if (session.faults.length > 0) return session.faults;
  const signal = session.signals.get('safety.faults');
  const found = [];
  for (let row = 1; signal && row < signal.topic.count && found.length < 200; ++row) {
    const before = signal.topic.values[(row - 1) * signal.topic.width + signal.column];
    const now = signal.topic.values[row * signal.topic.width + signal.column];
    if (now > before) found.push({ t: signal.topic.times[row], name: `${now - before} more`, joint: '' });
  }
  return found;
}

export function SafetyPanel({ session }) {
  useSession(session, 5);
  const level = session.value('safety.robot_level');
  const faults = faults_of(session);
  const seen = faults.filter((fault) => fault.t <= session.cursor_s);
  return (
    <div class="safety">
      <h3>Robot</h3>
      <Ladder level={level} />
      <div class="row">
        <p class="grow">{number(session.value('safety.faults'))} {session.value('safety.faults') === 1 ? 'fault' : 'faults'} since the start or the last clearing</p>
        <button disabled={!session.remote?.writes} onClick={() => session.remote.command('clear_faults')}>Clear</button>
      </div>
      {seen.length > 0 && (
        <ol class="faults">
          {[...seen].reverse().slice(0, 100).map((fault, i) => (
            <li key={i}>
              <button onClick={() => session.seek(fault.t)}>
                <time>{clock(fault.t)}</time><b>{fault.name}</b><span>{fault.joint}</span>
                {fault.words ? <small>{fault.words}</small> : fault.value !== undefined && <small>{number(fault.value)}, limit {number(fault.limit)}</small>}
              </button>
            </li>
          ))}
        </ol>
      )}
      <h3>Joints</h3>
      <Joints session={session} />
    </div>
  );
}
