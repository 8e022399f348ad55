// The world from above: where the robots are, what each of them believes to see, and what is really there when somebody
// knows. A number for each belief below.
import { from_above } from '../robot/outlines.js';
import { clock, number, useSession } from '../watching.js';

const fields_of = (session, prefix) => [...session.signals.keys()].filter((name) => name.startsWith(prefix)).map((name) => name.slice(prefix.length));
const place = (session, prefix) => ({ x: session.value(`${prefix}x_m`), y: session.value(`${prefix}y_m`) });
const known = ({ x, y }) => Number.isFinite(x) && Number.isFinite(y);

// Of the robot itself (prefix '') or of another one in its world ('red_2.'): where it truly is, else where its odometry
// says that it is.
function robot_at(session, prefix) {
  const base = `${prefix}plant.base.`;
  const really = { ...place(session, base), heading: session.value(`${base}yaw_rad`), really: true };
  if (known(really)) return really;
  const odometry = `${prefix}odometry.`;
  return { ...place(session, odometry), heading: session.value(`${odometry}heading_rad`), really: false };
}

function beliefs(session, prefix) {
  const names = fields_of(session, `${prefix}seen.`).filter((name) => name.endsWith('.age_s')).map((name) => name.slice(0, -'.age_s'.length));
  return names.map((name) => {
    const entry = `${prefix}seen.${name}.`;
    const value = (field) => session.value(entry + field);
    const numbers = fields_of(session, entry).filter((field) => !['age_s', 'confidence', 'carried'].includes(field));
    return { name, age_s: value('age_s'), confidence: value('confidence'), numbers: numbers.map((field) => [field, value(field)]), ...place(session, entry) };
  });
}

const from_robot = (robot, { x, y }) => {
  const [cos, sin] = [Math.cos(robot.heading), Math.sin(robot.heading)];
  return { x: robot.x + cos * x - sin * y, y: robot.y + sin * x + cos * y };
};

function world_of(session) {
  const prefixes = ['', ...[...session.others.keys()].map((name) => `${name}.`)];
  const robots = prefixes.map((prefix) => {
    const at = robot_at(session, prefix);
    const seen = beliefs(session, prefix);
    const drawn = seen.filter((entry) => entry.confidence > 0 && known(entry)).map((entry) => ({ ...entry, ...from_robot(at, entry) }));
    return { name: prefix.slice(0, -1) || (session.description?.robot.called ?? session.description?.robot.name), ...at, seen, drawn };
  });
  const things = (session.description?.world ?? []).map((thing) => from_above(session, thing));
  const driven = place(session, 'world.ground.');
  const ground = { markings: session.description?.ground?.markings ?? [], ...(known(driven) ? driven : { x: 0, y: 0 }) };
  return { robots: robots.filter(known), things, ground };
}

// Metres to a grid of 1, 2, 5, 10 ... with at most eight lines.
function grid_step(span) {
  const least = span / 8;
  const decade = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map((part) => part * decade).find((step) => step >= least);
}

function Grid({ x, y, size }) {
  const step = grid_step(size);
  const lines = [];
  for (let at = Math.ceil(x / step) * step; at <= x + size; at += step) lines.push(<line key={`x${at}`} x1={at} x2={at} y1={y} y2={y + size} />);
  for (let at = Math.ceil(y / step) * step; at <= y + size; at += step) lines.push(<line key={`y${at}`} y1={at} y2={at} x1={x} x2={x + size} />);
  return <g class="grid">{lines}<text x={x + size * 0.02} y={-(y + size * 0.02)} font-size={size * 0.035} transform="scale(1,-1)">{`grid ${number(step)} m`}</text></g>;
}

const around = ([x, y], radius) => [{ x: x - radius, y: y - radius }, { x: x + radius, y: y + radius }];
const marked = ({ lines, arcs }) => [...lines.flatMap((line) => [line.from_m, line.to_m]).map(([x, y]) => ({ x, y })), ...arcs.flatMap((arc) => around(arc.center_m, arc.radius_m))];

function Arc({ arc: { center_m: [x, y], radius_m, from_rad, to_rad }, line_m }) {
  if (to_rad - from_rad > 6.28) return <circle cx={x} cy={y} r={radius_m} stroke-width={line_m} />;
  const at = (angle) => `${x + radius_m * Math.cos(angle)} ${y + radius_m * Math.sin(angle)}`;
  return <path d={`M ${at(from_rad)} A ${radius_m} ${radius_m} 0 ${to_rad - from_rad > Math.PI ? 1 : 0} 1 ${at(to_rad)}`} stroke-width={line_m} />;
}

function Markings({ ground: { markings, x, y } }) {
  return markings.map(({ line_m, lines, arcs }, number) => (
    <g key={number} class="markings" transform={`translate(${x} ${y})`}>
      {lines.map(({ from_m, to_m }, i) => <line key={i} x1={from_m[0]} y1={from_m[1]} x2={to_m[0]} y2={to_m[1]} stroke-width={line_m} />)}
      {arcs.map((arc, i) => <Arc key={i} {...{ arc, line_m }} />)}
    </g>
  ));
}

// A thing that has no size of its own to speak of is a dot.
function Thing({ thing: { x, y, radius, outlines }, least }) {
  if (outlines.length === 0) return <circle class="thing ball" cx={x} cy={y} r={Math.max(radius ?? 0, least)} />;
  return outlines.map((corners, i) => <polygon key={i} class="thing" points={corners.map((corner) => `${corner.x},${corner.y}`).join(' ')} />);
}

const wide = ({ outlines }) => outlines.some((corners) => Math.hypot(corners[0].x - corners[2].x, corners[0].y - corners[2].y) > 20);

// x ahead is to the right, y to the left is up.
function Map({ robots, things, ground }) {
  const all = [...robots, ...robots.flatMap((robot) => robot.drawn), ...things.filter((thing) => !wide(thing)), ...ground.markings.flatMap(marked)];
  const [xs, ys] = [all.map(({ x }) => x), all.map(({ y }) => y)];
  const size = Math.max(2, 1.3 * Math.max(Math.max(...xs) - Math.min(...xs), Math.max(...ys) - Math.min(...ys)));
  const [x, y] = [(Math.max(...xs) + Math.min(...xs) - size) / 2, (Math.max(...ys) + Math.min(...ys) - size) / 2];
  const text = (at, label, name) => <text x={at.x} y={-at.y - size * 0.035} font-size={size * 0.04} transform="scale(1,-1)" class={name}>{label}</text>;
  return (
    <svg class="world-map" viewBox={`${x} ${-y - size} ${size} ${size}`} role="img" aria-label="The world from above">
      <g transform="scale(1,-1)">
        <Grid {...{ x, y, size }} />
        <Markings ground={ground} />
        {things.map((thing) => <Thing key={thing.name} {...{ thing, least: size * 0.01 }} />)}
        {robots.map((robot) => (
          <g key={robot.name} class={robot.really ? 'robot-at' : 'robot-at believed'}>
            {robot.drawn.map((entry) => (
              <g key={entry.name} class="belief" opacity={0.25 + 0.75 * entry.confidence}>
                <line x1={robot.x} y1={robot.y} x2={entry.x} y2={entry.y} />
                <circle cx={entry.x} cy={entry.y} r={size * 0.018} />
                {text(entry, entry.name)}
              </g>
            ))}
            <path d="M 0.16 0 L -0.1 0.12 L -0.05 0 L -0.1 -0.12 Z" transform={`translate(${robot.x} ${robot.y}) rotate(${((robot.heading || 0) * 180) / Math.PI}) scale(${Math.max(1, size * 0.15)})`} />
            {text(robot, robot.name, 'who')}
          </g>
        ))}
      </g>
    </svg>
  );
}

export function WorldPanel({ session }) {
  useSession(session, 5);
  const { robots, things, ground } = world_of(session);
  const seen = robots.flatMap((robot) => robot.seen.map((entry) => ({ ...entry, robot: robot.name })));
  if (robots.length === 0) return <p class="hint">Nothing says where this robot is.</p>;
  return (
    <div class="world">
      <Map {...{ robots, things, ground }} />
      <p class="muted">{robots.some(({ really }) => really) ? 'Filled: where things are. Rings: where a robot believes them, from where it is.' : 'Where the robot believes that it is, and what it believes to see.'}</p>
      {seen.length === 0 ? <p class="hint">No entries: this robot has no world model (docs/supervisor.md).</p> : (
        <table class="joints">
          <thead><tr><th>Entry</th><th>Age</th><th>Confidence</th><th>What</th></tr></thead>
          <tbody>
            {seen.map((entry) => (
              <tr key={`${entry.robot}.${entry.name}`} class={entry.confidence > 0 ? '' : 'muted'}>
                <td>{robots.length > 1 ? `${entry.robot}: ${entry.name}` : entry.name}</td>
                <td>{entry.confidence > 0 ? clock(entry.age_s) : '–'}</td>
                <td>{number(entry.confidence, 2)}</td>
                <td>{entry.numbers.map(([field, value]) => `${field} ${number(value, 3)}`).join(', ')}</td>
              </tr>
            ))}
          </tbody>
        </table>
      )}
    </div>
  );
}
