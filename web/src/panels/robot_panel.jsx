// The robot in 3D at the time that is looked at, with what bears it.
import { useEffect, useRef, useState } from 'preact/hooks';
import { BalanceMarks, mark_colors } from '../robot/balance_marks.js';
import { PushHand } from '../robot/push_hand.js';
import { RobotModel } from '../robot/robot_model.js';
import { Stage } from '../robot/stage.js';

const marks = [
  ['contacts', 'Forces', mark_colors.force],
  ['cop', 'CoP', mark_colors.cop],
  ['com', 'CoM', mark_colors.com],
  ['dcm', 'DCM', mark_colors.dcm],
  ['support', 'Support', mark_colors.support],
];
const css = (color) => `#${color.toString(16).padStart(6, '0')}`;

// What stands on the stage for a session; made when its URDF and description are there.
class Show {
  constructor(stage) {
    this.stage = stage;
    this.session = null;
  }

  take(session) {
    if (this.session === session && this.urdf === session.urdf && this.description === session.description) return;
    if (this.model) this.stage.scene.remove(this.model.root, this.marks.root);
    this.model = null;
    [this.session, this.urdf, this.description] = [session, session.urdf, session.description];
    if (!session.urdf) return;
    this.model = new RobotModel(session.urdf, session.mesh_base ?? './assets/');
    this.marks = new BalanceMarks(session.description?.robot?.feet ?? []);
    this.stage.scene.add(this.model.root, this.marks.root);
  }

  draw(t, shown) {
    if (this.model) {
      this.marks.update(this.session, t, this.model, shown);
      this.stage.follow(this.model.root.position);
    }
    this.stage.draw();
  }
}

export function RobotPanel({ session, theme, frames }) {
  const canvas = useRef();
  const stage = useRef();
  const show = useRef();
  const [shown, set_shown] = useState(() => new Set(['contacts', 'cop', 'com', 'dcm', 'support']));
  const drawn = useRef('');
  const latest = useRef();
  latest.current = { session, shown, theme };

  useEffect(() => {
    stage.current = new Stage(canvas.current);
    show.current = new Show(stage.current);
    globalThis.kadans_stage = stage.current;
    const pushed = () => latest.current.session.remote?.writes && latest.current.session.remote.verbs.has('push');
    const push = (link, impulse_Ns) => latest.current.session.remote.command('push', { text: `${link}=${impulse_Ns.map((part) => part.toFixed(3)).join(',')}` });
    new PushHand(stage.current, () => (pushed() ? show.current.model : null), push);
    const draw = () => {
      const { clientWidth, clientHeight } = canvas.current.parentElement;
      if (clientWidth === 0 || clientHeight === 0) return;
      stage.current.resize(clientWidth, clientHeight);
      const now = latest.current;
      const { cursor_s, version } = now.session;
      const sign = [cursor_s, version, clientWidth, clientHeight, now.theme, ...now.shown].join();
      if (sign === drawn.current && !stage.current.moved) return; // nothing that moved: let the machine rest
      drawn.current = sign;
      stage.current.moved = false;
      show.current.take(now.session);
      show.current.draw(now.session.cursor_s, now.shown);
    };
    const leave = frames.add(draw);
    return () => {
      leave();
      stage.current.dispose();
    };
  }, []);
  useEffect(() => stage.current.set_theme(theme), [theme]);

  const toggle = (name) => {
    const next = new Set(shown);
    if (!next.delete(name)) next.add(name);
    set_shown(next);
  };
  return (
    <section class="robot" aria-label="Robot">
      <div class="stage"><canvas ref={canvas} id="robot" /></div>
      <div class="marks">
        {marks.map(([name, label, color]) => (
          <button key={name} class="mark" aria-pressed={shown.has(name)} onClick={() => toggle(name)}>
            <i style={{ background: css(color) }} />{label}
          </button>
        ))}
        {session.remote?.writes && session.remote.verbs.has('push') && <span class="tip">shift and drag a link: push</span>}
        <button class="mark" title="Look from the start again (f)" onClick={() => stage.current.look_from_start()}>Reset view</button>
      </div>
    </section>
  );
}
