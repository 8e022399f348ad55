// The ladder of safety, rung by rung, for the robot and each joint, the faults that led there, and what the drives say.
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

// What may be asked of a drive in each of its states.
const orders = { off: ['enable_drives', 'Enable'], ready: ['enable_drives', 'Enable'], enabled: ['disable_drives', 'Disable'], homing: ['disable_drives', 'Disable'], fault: ['reset_drives', 'Reset'] };

function Drive({ session, drive }) {
  const [verb, word] = orders[drive.state] ?? [];
  const remarks = [drive.code !== 0 && `code ${drive.code}`, !drive.homed && 'not homed', drive.braked && 'braked'];
  return (
    <tr>
      <td>{drive.joint}</td>
      <td><span class={`chip drive_${drive.state}`}>{drive.state}</span></td>
      <td>{drive.temperature_C === null ? '' : `${drive.temperature_C.toFixed(1)} °C`}</td>
      <td>{remarks.filter(Boolean).join(', ')}</td>
      <td>{verb && <button disabled={!session.remote?.writes} aria-label={`${word} ${drive.joint}`} onClick={() => session.remote.command(verb, { text: drive.joint })}>{word}</button>}</td>
    </tr>
  );
}

// Of a run; a record does not hold it.
function Drives({ session }) {
  const { drives, supply_V, emergency } = session.drives;
  return (
    <>
      <h3>Drives</h3>
      {(supply_V !== null || emergency) && <p>{supply_V !== null && `Supply ${supply_V.toFixed(1)} V. `}{emergency && 'The emergency stop is pressed.'}</p>}
      <table class="joints">
        <thead><tr><th>Joint</th><th>State</th><th>Drive</th><th /><th /></tr></thead>
        <tbody>{drives.map((drive) => <Drive key={drive.joint} session={session} drive={drive} />)}</tbody>
      </table>
    </>
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
      {session.drives && <Drives session={session} />}
    </div>
  );
}
