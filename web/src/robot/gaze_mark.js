// Where a gaze object looks: its target, and a line from each eye to it. Who may write leads the target with the mouse,
// in the plane that faces the camera; each next point is sent when the run has taken the last.
import { BufferGeometry, Group, Line, LineBasicMaterial, Mesh, MeshBasicMaterial, Plane, Raycaster, SphereGeometry, Vector2, Vector3 } from 'three';

const color = 0xb8479b;
const far_m = 5; // from the base, at most
const move_s = 0.05;

export class GazeMark {
  // `object`: of the description, of type gaze; `send(set_points)`: null where nothing may be sent.
  constructor(stage, object, model, send) {
    Object.assign(this, { stage, object, model, send, ray: new Raycaster(), plane: new Plane(), held: null, waits: false });
    this.root = new Group();
    this.ball = new Mesh(new SphereGeometry(0.022, 24, 16), new MeshBasicMaterial({ color }));
    this.ball.name = 'gaze target';
    this.grip = new Mesh(new SphereGeometry(0.06, 12, 8), new MeshBasicMaterial({ visible: false })); // easier to take
    this.eyes = [object.options?.left_eye, object.options?.right_eye].filter((eye) => eye && model.link(eye));
    this.lines = this.eyes.map(() => new Line(new BufferGeometry(), new LineBasicMaterial({ color, transparent: true, opacity: 0.45 })));
    for (const line of this.lines) line.frustumCulled = false;
    this.ball.add(this.grip);
    this.root.add(this.ball, ...this.lines);
    this.listeners = { pointerdown: (event) => this.take(event), pointermove: (event) => this.lead(event), pointerup: () => this.let_go() };
    for (const [name, listener] of Object.entries(this.listeners)) stage.renderer.domElement.addEventListener(name, listener, { capture: true });
  }

  dispose() {
    for (const [name, listener] of Object.entries(this.listeners)) this.stage.renderer.domElement.removeEventListener(name, listener, { capture: true });
  }

  // The model is posed at t.
  update(session, t) {
    const at = ['x', 'y', 'z'].map((axis) => session.value(`control.${this.object.name}.target_${axis}_m`, t));
    this.root.visible = at.every(Number.isFinite);
    if (!this.root.visible) return;
    this.model.root.localToWorld(this.ball.position.set(...at));
    if (this.held) this.ball.position.copy(this.held);
    const eye = new Vector3();
    this.eyes.forEach((name, i) => this.lines[i].geometry.setFromPoints([this.model.link(name).getWorldPosition(eye).clone(), this.ball.position]));
  }

  aim(event) {
    const box = this.stage.renderer.domElement.getBoundingClientRect();
    const at = new Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
    this.ray.setFromCamera(at, this.stage.camera);
  }

  take(event) {
    if (!this.send() || event.button !== 0 || event.shiftKey || !this.root.visible) return;
    this.aim(event);
    if (this.ray.intersectObject(this.grip).length === 0) return;
    this.plane.setFromNormalAndCoplanarPoint(this.stage.camera.getWorldDirection(new Vector3()), this.ball.position);
    this.held = this.ball.position.clone();
    this.left = false;
    this.stage.controls.enabled = false;
    this.stage.renderer.domElement.setPointerCapture?.(event.pointerId);
    event.stopImmediatePropagation();
  }

  lead(event) {
    if (!this.held) {
      this.aim(event);
      const over = this.root.visible && this.send() && this.ray.intersectObject(this.grip).length > 0;
      this.stage.renderer.domElement.style.cursor = over ? 'grab' : '';
      return;
    }
    if (this.left) return;
    this.aim(event);
    if (!this.ray.ray.intersectPlane(this.plane, this.held)) return;
    this.stage.moved = true;
    if (!this.waits) this.tell();
  }

  // Where the hand is, one order at a time; where it let go is always the last.
  async tell() {
    const to = this.held.clone();
    this.waits = true;
    const at = this.model.root.worldToLocal(to.clone()).clampLength(0, far_m);
    const text = ['x', 'y', 'z'].map((axis) => `${this.object.name}.${axis}_m=${at[axis].toFixed(4)}`).join();
    await this.send()?.(text, move_s);
    this.waits = false;
    if (this.held && this.held.distanceTo(to) > 1e-3) await this.tell();
    if (this.left) this.held = null;
  }

  let_go() {
    if (!this.held) return;
    this.left = true;
    if (!this.waits) this.tell();
    this.stage.moved = true;
    this.stage.controls.enabled = true;
  }
}
