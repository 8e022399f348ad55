// The robot in 3D at the time that is looked at, with what bears it and where it looks.
import { useLayoutEffect, useRef, useState } from 'preact/hooks';
import { mark_colors } from '../robot/mark_colors.js';
import { useSession, useShown } from '../watching.js';
import { StartPanel } from './start_panel.jsx';

const marks = [
  ['contacts', 'Forces', mark_colors.force],
  ['cop', 'CoP', mark_colors.cop],
  ['com', 'CoM', mark_colors.com],
  ['dcm', 'DCM', mark_colors.dcm],
  ['support', 'Support', mark_colors.support],
];
const css = (color) => `#${color.toString(16).padStart(6, '0')}`;
const stands = (session) => (session.description?.robot?.feet ?? []).length > 0;

function Tip({ session }) {
  const { remote } = session;
  if (!remote?.writes) return null;
  if (session.description?.objects?.some((object) => object.type === 'gaze')) return <span class="tip">drag the target: gaze</span>;
  return remote.verbs.has('push') ? <span class="tip">shift and drag a link: push</span> : null;
}

export function RobotPanel({ session, theme, drawing, open }) {
  const place = useRef();
  const view = useRef();
  const [shown, set_shown] = useState(() => new Set(marks.map(([name]) => name)));
  const [problem, set_problem] = useState('');
  const seen = useShown({ session, shown, theme });
  useSession(session, 2);

  useLayoutEffect(() => {
    drawing
      .then((made) => {
        view.current = made;
        place.current.append(made.canvas);
        made.now = () => seen.current;
      })
      .catch((error) => set_problem(String(error.message ?? error)));
  }, []);

  const toggle = (name) => {
    const next = new Set(shown);
    if (!next.delete(name)) next.add(name);
    set_shown(next);
  };
  const offered = marks.filter(([name]) => stands(session) || name === 'com');
  return (
    <section class="robot" aria-label="Robot">
      <div class="stage" ref={place} />
      {problem && <p class="hint error">The robot cannot be drawn: {problem}</p>}
      {session.urdf ? (
        <div class="marks">
          {offered.map(([name, label, color]) => (
            <button key={name} class="mark" aria-pressed={shown.has(name)} onClick={() => toggle(name)}>
              <i style={{ background: css(color) }} />{label}
            </button>
          ))}
          <button class="mark" title="Look from the start again (f)" onClick={() => view.current?.stage.look_from_start()}>Reset view</button>
          <Tip session={session} />
        </div>
      ) : (
        <StartPanel {...{ session, open }} />
      )}
    </section>
  );
}
