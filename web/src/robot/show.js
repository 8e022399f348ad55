// What stands on the stage for a session: the robot, what bears it, what it carries, where it looks, the ground, and the
// further robots and things of its world. Made when its URDF is there.
import { Vector3 } from 'three';
import { BalanceMarks } from './balance_marks.js';
import { GazeMark } from './gaze_mark.js';
import { Payloads } from './payloads.js';
import { RobotModel } from './robot_model.js';
import { WorldObjects } from './world_objects.js';

const beside = new Vector3(0.9, 2.4, 0.5); // where robot and what it looks at are both seen

export class Show {
  constructor(stage) {
    this.stage = stage;
  }

  // Of a description only what is drawn: behaviors come and go in it.
  take(session) {
    const { robot, objects, world, ground, payloads } = session.description ?? {};
    const key = JSON.stringify([robot, objects, world, ground, payloads]);
    const same = this.session === session && this.urdf === session.urdf && this.others?.length === session.others.size;
    if (same && (this.description === session.description || this.key === key)) return;
    this.clear();
    const same_robot = this.session === session && this.urdf === session.urdf;
    Object.assign(this, { session, urdf: session.urdf, description: session.description, key });
    if (!session.urdf) return;
    this.model = new RobotModel(session.urdf, this.stage.fine);
    this.others = [...session.others].map(([name, urdf]) => new RobotModel(urdf, this.stage.fine, `${name}.`));
    const { model } = this;
    model.complete?.then(() => {
      if (this.model !== model) return;
      this.framed = false;
      this.stage.moved = true;
    });
    this.marks = new BalanceMarks(robot?.feet ?? [], this.stage.ground);
    this.gazes = (objects ?? []).filter((object) => object.type === 'gaze').map((object) => new GazeMark(this.stage, object, this.model, () => this.sender()));
    this.world = new WorldObjects(world ?? []);
    this.payloads = new Payloads(payloads ?? [], this.model);
    this.stage.ground.lay(ground);
    this.marks.root.visible = this.stage.fine;
    this.stage.scene.add(...this.roots());
    this.framed = same_robot && this.framed;
  }

  roots() {
    return [this.model.root, this.marks.root, this.world.root, ...[...this.gazes, ...this.others].map((part) => part.root)];
  }

  // Once it is known how large the robot is and where it is.
  frame() {
    this.framed = Boolean(this.session.description) && this.session.signals.size > 0 && this.session.end_s > 0;
    this.stage.ground.move(this.session, this.session.cursor_s);
    this.model.pose(this.session, this.session.cursor_s);
    const base = this.model.root.position;
    const { center, radius } = this.model.bounds();
    this.marks.com_ball.scale.setScalar(Math.min(1, radius / 0.6));
    if (this.others.length > 0) {
      const all = this.model.bounds();
      for (const other of this.others) {
        other.pose(this.session, this.session.cursor_s);
        all.union(other.bounds());
      }
      return this.stage.frame(all.center, all.radius, base);
    }
    if (this.gazes.length > 0) return this.stage.frame(center.setX(center.x + 0.4), Math.max(radius, 0.62), base, beside);
    const { radius: tall } = this.model;
    const ground_m = this.stage.ground.height_m(base.x, base.y);
    if (this.marks.feet.length > 0) return this.stage.frame(center.set(base.x, base.y, ground_m + 0.86 * tall), 1.14 * tall, base); // as if it stood
    return this.stage.frame(center, radius, base);
  }

  clear() {
    if (!this.model) return;
    this.stage.scene.remove(...this.roots());
    for (const gaze of this.gazes) gaze.dispose();
    this.model = null;
  }

  sender() {
    const { remote } = this.session;
    if (!remote?.writes || !remote.verbs.has('set_point')) return null;
    return (text, value) => remote.command('set_point', { text, value });
  }

  draw(t, shown) {
    if (this.model) {
      if (!this.framed) this.frame();
      this.stage.ground.move(this.session, t);
      this.marks.update(this.session, t, this.model, shown);
      for (const other of this.others) other.pose(this.session, t);
      this.world.update(this.session, t);
      this.payloads.update(t);
      for (const gaze of this.gazes) gaze.update(this.session, t);
      this.stage.follow(this.model.root.position);
    }
    this.stage.draw();
    if (!this.model || this.marks.root.visible) return;
    this.marks.root.visible = this.stage.moved = true; // the robot is seen first: what is beside it takes programs of its own
  }
}
