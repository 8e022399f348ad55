// Where the things of the world are, and what they look like from above: balls as circles, what is made of boxes as their hulls.
import { Euler, Quaternion, Vector3 } from 'three';
import { hull } from './hull.js';

// Where a thing of a description's world is at t, and how a free box is turned then; without signals as it stood at the start.
export function placed(session, { name, position_m }, t) {
  const values = (...fields) => fields.map((field) => session.value(`world.${name}.${field}`, t));
  const at_m = values('x_m', 'y_m', 'z_m');
  const angles = values('roll_rad', 'pitch_rad', 'yaw_rad');
  return {
    at_m: at_m.every(Number.isFinite) ? at_m : position_m,
    turn: angles.every(Number.isFinite) ? new Quaternion().setFromEuler(new Euler(...angles, 'ZYX')) : null,
  };
}

function outline(size_m, centre_m, turn) {
  const corners = [-0.5, 0.5].flatMap((x) => [-0.5, 0.5].flatMap((y) => [-0.5, 0.5].map((z) => [x, y, z])));
  return hull(corners.map((corner) => {
    const { x, y } = new Vector3(...corner.map((share, axis) => share * size_m[axis])).applyQuaternion(turn);
    return { x: centre_m[0] + x, y: centre_m[1] + y };
  }));
}

// {name, x, y, radius, outlines: [[{x, y}]]} at the time that is looked at; `thing`: of a description's world.
export function from_above(session, thing) {
  const { name, position_m, radius_m, boxes = [] } = thing;
  const { at_m: [x, y], turn } = placed(session, thing);
  const outlines = boxes.map((box) => {
    const centre_m = [box.position_m[0] + x - position_m[0], box.position_m[1] + y - position_m[1]];
    return outline(box.size_m, centre_m, turn ?? new Quaternion(...box.orientation_xyzw));
  });
  return { name, x, y, radius: radius_m, outlines };
}
