// Pushes the robot of a simulation: hold shift, take a link with the mouse, pull, let go. The arrow is the impulse.
import { ArrowHelper, Plane, Raycaster, Vector2, Vector3 } from 'three';

const impulse_per_metre_Ns = 10;
const impulse_max_Ns = 10;

function link_of(part) {
  while (part && !part.isURDFLink) part = part.parent;
  return part?.name ?? part?.urdfName;
}

export class PushHand {
  // `model()`: the robot now, or null; `push(link, impulse_Ns)`: [x, y, z] in the world.
  constructor(stage, model, push) {
    Object.assign(this, { stage, model, push, ray: new Raycaster(), plane: new Plane(), from: new Vector3(), to: new Vector3() });
    this.arrow = new ArrowHelper(new Vector3(1, 0, 0), this.from, 0.1, 0xd1495b, 0.05, 0.03);
    for (const part of [this.arrow.line, this.arrow.cone]) part.material.depthTest = false;
    this.arrow.renderOrder = 9;
    this.arrow.visible = false;
    stage.scene.add(this.arrow);
    const canvas = stage.renderer.domElement;
    canvas.addEventListener('pointerdown', (event) => this.take(event), { capture: true });
    canvas.addEventListener('pointermove', (event) => this.pull(event));
    canvas.addEventListener('pointerup', () => this.let_go());
  }

  aim(event) {
    const box = this.stage.renderer.domElement.getBoundingClientRect();
    const at = new Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
    this.ray.setFromCamera(at, this.stage.camera);
  }

  take(event) {
    const model = this.model();
    if (!event.shiftKey || event.button !== 0 || !model) return;
    this.aim(event);
    const hit = this.ray.intersectObject(model.root, true).find(({ object }) => object.isMesh);
    if (!hit) return;
    this.link = link_of(hit.object);
    this.from.copy(hit.point);
    this.to.copy(hit.point);
    this.plane.setFromNormalAndCoplanarPoint(this.stage.camera.getWorldDirection(new Vector3()), hit.point);
    this.stage.controls.enabled = false;
    event.stopImmediatePropagation();
  }

  impulse() {
    return this.to.clone().sub(this.from).multiplyScalar(impulse_per_metre_Ns).clampLength(0, impulse_max_Ns);
  }

  pull(event) {
    if (!this.link) return;
    this.aim(event);
    if (!this.ray.ray.intersectPlane(this.plane, this.to)) return;
    this.stage.moved = true;
    const length = this.impulse().length() / impulse_per_metre_Ns;
    this.arrow.visible = length > 0.02;
    this.arrow.position.copy(this.from);
    this.arrow.setDirection(this.impulse().normalize());
    this.arrow.setLength(Math.max(0.05, length), 0.05, 0.03);
  }

  let_go() {
    if (!this.link) return;
    const impulse = this.impulse();
    if (impulse.length() > 0.05) this.push(this.link, impulse.toArray());
    this.link = null;
    this.stage.moved = true;
    this.arrow.visible = false;
    this.stage.controls.enabled = true;
  }
}
