// The ground as the plant has it: a plane through the world's origin, which may slope and be driven, with a grid, the
// robot's shadow and what is painted on it. A description without a ground, as of a robot that no model simulates, has a
// level one.
import {
  BufferGeometry, Color, Float32BufferAttribute, Group, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial,
  PlaneGeometry, RingGeometry, ShadowMaterial, Vector3,
} from 'three';

const below_m = 0.001; // the grid, so that nothing flickers
const above_m = 0.001; // what is painted
const segments_per_turn = 96;

// Lines each quarter of a metre, whole metres stronger. In pieces: some machines lose a line that begins behind the eye.
function make_grid(theme) {
  const [reach, step, piece] = [7, 0.25, 1];
  const [points, colors] = [[], []];
  for (let at = -reach; at <= reach; at += step) {
    const { r, g, b } = new Color(Number.isInteger(at) ? theme.grid : theme.lines);
    for (let from = -reach; from < reach; from += piece) {
      points.push(at, from, 0, at, from + piece, 0, from, at, 0, from + piece, at, 0);
      for (let i = 0; i < 4; ++i) colors.push(r, g, b);
    }
  }
  const lines = new BufferGeometry();
  lines.setAttribute('position', new Float32BufferAttribute(points, 3));
  lines.setAttribute('color', new Float32BufferAttribute(colors, 3));
  return new LineSegments(lines, new LineBasicMaterial({ vertexColors: true, toneMapped: false }));
}

// A painted line reaches half its width beyond both ends, so that two that meet at a corner fill it.
function painted_line({ from_m: [x0, y0], to_m: [x1, y1] }, line_m, paint) {
  const line = new Mesh(new PlaneGeometry(Math.hypot(x1 - x0, y1 - y0) + line_m, line_m), paint);
  line.position.set((x0 + x1) / 2, (y0 + y1) / 2, above_m);
  line.rotation.z = Math.atan2(y1 - y0, x1 - x0);
  return line;
}

function painted_arc({ center_m: [x, y], radius_m, from_rad, to_rad }, line_m, paint) {
  const turn_rad = Math.min(to_rad - from_rad, 2 * Math.PI);
  const segments = Math.ceil((segments_per_turn * turn_rad) / (2 * Math.PI));
  const [inner_m, outer_m] = [Math.max(0, radius_m - line_m / 2), radius_m + line_m / 2];
  const arc = new Mesh(new RingGeometry(inner_m, outer_m, segments, 1, from_rad, turn_rad), paint);
  arc.position.set(x, y, above_m);
  return arc;
}

export class Ground {
  constructor(fine) {
    this.root = new Group();
    this.root.name = 'ground';
    this.up = new Vector3(0, 0, 1);
    this.shade = new Mesh(new PlaneGeometry(5, 5), new ShadowMaterial());
    this.shade.receiveShadow = true;
    this.shade.material.depthWrite = false; // or it would hide the grid below it
    this.shade.visible = fine;
    this.paint = new MeshBasicMaterial({ toneMapped: false });
    this.markings = new Group();
    this.markings.name = 'markings';
    this.root.add(this.shade, this.markings);
  }

  set_theme(theme) {
    if (this.grid) this.root.remove(this.grid);
    this.grid = make_grid(theme);
    this.grid.name = 'grid';
    this.grid.position.z = -below_m;
    this.root.add(this.grid);
    this.shade.material.opacity = theme.shadow;
    this.paint.color = new Color(theme.paint);
  }

  // `described`: of the description; undefined is level.
  lay(described) {
    this.root.quaternion.set(...(described?.orientation_xyzw ?? [0, 0, 0, 1]));
    this.root.position.set(0, 0, 0);
    this.up.set(0, 0, 1).applyQuaternion(this.root.quaternion);
    for (const part of this.markings.children) part.geometry.dispose();
    this.markings.clear();
    for (const { line_m, lines, arcs } of described?.markings ?? []) {
      for (const line of lines) this.markings.add(painted_line(line, line_m, this.paint));
      for (const arc of arcs) this.markings.add(painted_arc(arc, line_m, this.paint));
    }
  }

  // To where it was driven by then.
  move(session, t) {
    const at_m = ['x', 'y', 'z'].map((axis) => session.value(`world.ground.${axis}_m`, t));
    this.root.position.set(...(at_m.every(Number.isFinite) ? at_m : [0, 0, 0]));
    this.root.updateMatrixWorld(true);
  }

  height_m(x_m, y_m) {
    const { x, y, z } = this.root.position;
    return z - (this.up.x * (x_m - x) + this.up.y * (y_m - y)) / this.up.z;
  }

  // Grid and shadow are there where somebody is, on lines that stay where they are.
  follow(x_m, y_m) {
    const at = this.root.worldToLocal(new Vector3(x_m, y_m, this.height_m(x_m, y_m)));
    this.shade.position.set(at.x, at.y, 0);
    this.grid.position.set(Math.round(at.x), Math.round(at.y), -below_m);
  }
}
