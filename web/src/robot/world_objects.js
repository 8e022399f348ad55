// The objects of the world around the robot: balls and boxes, as the description has them. Those that move have signals.
import { BoxGeometry, Group, Mesh, MeshStandardMaterial, SphereGeometry } from 'three';

const ball_color = 0xe8762b;
const box_color = 0x9aa7b4;

function mesh(geometry, color) {
  const made = new Mesh(geometry, new MeshStandardMaterial({ color, roughness: 0.6 }));
  made.castShadow = made.receiveShadow = true;
  return made;
}

export class WorldObjects {
  constructor(objects) {
    this.root = new Group();
    this.objects = objects.map(({ name, position_m, radius_m, boxes }) => {
      const group = new Group();
      if (radius_m) group.add(mesh(new SphereGeometry(radius_m, 32, 20), ball_color));
      for (const box of boxes ?? []) {
        const part = mesh(new BoxGeometry(...box.size_m), box_color);
        part.position.set(...box.position_m.map((at_m, axis) => at_m - position_m[axis]));
        part.quaternion.set(...box.orientation_xyzw);
        group.add(part);
      }
      this.root.add(group);
      return { name, position_m, group };
    });
  }

  update(session, t) {
    for (const { name, position_m, group } of this.objects) {
      const at_m = ['x', 'y', 'z'].map((axis) => session.value(`world.${name}.${axis}_m`, t));
      group.position.set(...(at_m.every(Number.isFinite) ? at_m : position_m));
    }
  }
}
