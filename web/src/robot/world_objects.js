// The objects of the world around the robot: balls, boxes, and pendulums, as the description has them. Those that move have
// signals.
import { BoxGeometry, BufferGeometry, Group, Line, LineBasicMaterial, Mesh, MeshStandardMaterial, Quaternion, SphereGeometry, Vector3 } from 'three';
import { placed } from './outlines.js';

const ball_color = 0xe8762b;
const box_color = 0x9aa7b4;

function mesh(geometry, color) {
  const made = new Mesh(geometry, new MeshStandardMaterial({ color, roughness: 0.6 }));
  made.castShadow = made.receiveShadow = true;
  return made;
}

class WorldThing {
  constructor({ name, position_m, radius_m, hinge_m, boxes }) {
    Object.assign(this, { name, position_m });
    this.group = new Group();
    this.group.name = name;
    this.parts = [this.group];
    if (radius_m) this.group.add(mesh(new SphereGeometry(radius_m, 32, 20), ball_color));
    for (const box of boxes ?? []) {
      const part = mesh(new BoxGeometry(...box.size_m), box_color);
      part.position.set(...box.position_m.map((at_m, axis) => at_m - position_m[axis]));
      part.quaternion.set(...box.orientation_xyzw);
      this.group.add(part);
    }
    this.turned = new Quaternion(...(boxes?.[0]?.orientation_xyzw ?? [0, 0, 0, 1])); // as its first box is drawn
    if (!hinge_m) return;
    this.hinge = new Vector3(...hinge_m);
    this.rod = new Line(new BufferGeometry(), new LineBasicMaterial({ color: box_color }));
    this.rod.frustumCulled = false;
    this.rod.name = `rod of ${name}`;
    this.parts.push(this.rod);
  }

  update(session, t) {
    const { at_m, turn } = placed(session, this, t);
    this.group.position.set(...at_m);
    this.rod?.geometry.setFromPoints([this.hinge, this.group.position]);
    if (turn) this.group.quaternion.copy(turn).multiply(this.turned.clone().invert());
  }
}

export class WorldObjects {
  constructor(objects) {
    this.root = new Group();
    this.things = objects.map((object) => new WorldThing(object));
    for (const part of this.things.flatMap((thing) => thing.parts)) this.root.add(part);
  }

  update(session, t) {
    for (const thing of this.things) thing.update(session, t);
  }
}
