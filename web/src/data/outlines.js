// What the things of the world look like from above: balls as circles, everything made of boxes as the hulls of these.
import { hull } from '../robot/hull.js';

function turned([x, y, z, w], v) {
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const twice = cross([x, y, z], v).map((part) => 2 * part);
  return cross([x, y, z], twice).map((part, axis) => v[axis] + w * twice[axis] + part);
}

function turn_of(roll, pitch, yaw) {
  const [cr, sr, cp, sp, cy, sy] = [roll, pitch, yaw].flatMap((angle) => [Math.cos(angle / 2), Math.sin(angle / 2)]);
  return [sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy, cr * cp * cy + sr * sp * sy];
}

function outline(size_m, centre_m, orientation_xyzw) {
  const corners = [-0.5, 0.5].flatMap((x) => [-0.5, 0.5].flatMap((y) => [-0.5, 0.5].map((z) => [x, y, z])));
  return hull(corners.map((corner) => {
    const [x, y] = turned(orientation_xyzw, corner.map((share, axis) => share * size_m[axis]));
    return { x: centre_m[0] + x, y: centre_m[1] + y };
  }));
}

// {name, x, y, radius, outlines: [[{x, y}]]} at the time that is looked at; `thing`: of a description's world.
export function from_above(session, { name, position_m, radius_m, boxes = [] }) {
  const values = (...fields) => fields.map((field) => session.value(`world.${name}.${field}`));
  const at_m = values('x_m', 'y_m', 'z_m');
  const [x, y] = at_m.every(Number.isFinite) ? at_m : position_m;
  const angles = values('roll_rad', 'pitch_rad', 'yaw_rad');
  const outlines = boxes.map((box) => {
    const centre_m = [box.position_m[0] + x - position_m[0], box.position_m[1] + y - position_m[1]];
    return outline(box.size_m, centre_m, angles.every(Number.isFinite) ? turn_of(...angles) : box.orientation_xyzw);
  });
  return { name, x, y, radius: radius_m, outlines };
}
