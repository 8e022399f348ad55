// What is drawn about the robot's balance: forces under the feet, centres of pressure, the support polygon, the centre
// of mass with its plumb line, and the divergent component of motion.
import {
  ArrowHelper, BufferGeometry, Float32BufferAttribute, Group, Line, LineBasicMaterial, Mesh, MeshBasicMaterial,
  RingGeometry, CircleGeometry, SphereGeometry, Vector3, DoubleSide, LineLoop,
} from 'three';
import { hull } from './hull.js';
import { mark_colors } from './mark_colors.js';

const metres_per_newton = 1 / 350;
const lift_m = 0.003; // above the ground, so that nothing flickers
const up = new Vector3(0, 0, 1);

const flat = (geometry, color, opacity = 1) =>
  new Mesh(geometry, new MeshBasicMaterial({ color, transparent: true, opacity, side: DoubleSide, depthTest: false }));

class Foot {
  constructor(info) {
    this.info = info;
    this.corners = info.corners_m.map((corner) => new Vector3(...corner));
    this.arrow = new ArrowHelper(up, new Vector3(), 0.1, mark_colors.force, 0.04, 0.025);
    this.dot = flat(new CircleGeometry(0.009, 24), mark_colors.cop);
    for (const part of [this.arrow.line, this.arrow.cone, this.dot]) {
      part.renderOrder = 5;
      part.material.depthTest = false; // seen through the robot
      part.material.transparent = true;
    }
    this.cop = new Vector3();
    this.force_N = 0;
  }

  update(session, t, model) {
    const { link } = this.info;
    const node = model.link(link);
    const contact = session.value(`foot.${link}.contact`, t) > 0.5;
    const force_N = session.value(`foot.${link}.force_N`, t);
    this.bears = Boolean(node) && contact && force_N > 1;
    this.force_N = this.bears ? force_N : 0;
    if (!this.bears) return;
    this.cop.set(session.value(`foot.${link}.cop_x_m`, t), session.value(`foot.${link}.cop_y_m`, t), this.corners[0].z);
    this.cop.applyMatrix4(node.matrixWorld);
    this.arrow.position.copy(this.cop);
    this.arrow.setLength(Math.max(0.03, force_N * metres_per_newton), 0.035, 0.022);
    this.dot.position.copy(this.cop).z += lift_m;
  }

  // Over the ground's plane: what it stands on may lie on that.
  over_m(ground) {
    return this.cop.z - ground.height_m(this.cop.x, this.cop.y);
  }

  ground_points(model) {
    const node = model.link(this.info.link);
    return this.corners.map((corner) => corner.clone().applyMatrix4(node.matrixWorld));
  }
}

export class BalanceMarks {
  constructor(feet, ground) {
    this.ground = ground;
    this.root = new Group();
    this.feet = feet.map((info) => new Foot(info));
    this.com = new Vector3();
    this.dcm = new Vector3();
    this.com_ball = new Mesh(new SphereGeometry(0.022, 24, 16), new MeshBasicMaterial({ color: mark_colors.com, depthTest: false, transparent: true }));
    this.plumb = new Line(new BufferGeometry().setFromPoints([new Vector3(), new Vector3()]), new LineBasicMaterial({ color: mark_colors.com, transparent: true, opacity: 0.7 }));
    this.com_spot = flat(new RingGeometry(0.011, 0.016, 28), mark_colors.com);
    this.dcm_spot = flat(new RingGeometry(0.013, 0.02, 28), mark_colors.dcm);
    this.cop_spot = flat(new CircleGeometry(0.014, 28), mark_colors.cop);
    this.area = flat(new BufferGeometry(), mark_colors.support, 0.16);
    this.outline = new LineLoop(new BufferGeometry(), new LineBasicMaterial({ color: mark_colors.support }));
    this.groups = {
      contacts: this.feet.flatMap((foot) => [foot.arrow, foot.dot]),
      cop: [this.cop_spot],
      com: [this.com_ball, this.plumb, this.com_spot],
      dcm: [this.dcm_spot],
      support: [this.area, this.outline],
    };
    for (const [name, parts] of Object.entries(this.groups)) {
      for (const part of parts) {
        part.renderOrder = name === 'support' ? 2 : Math.max(part.renderOrder, 4);
        part.frustumCulled = false;
        this.root.add(part);
      }
    }
  }

  // `shown`: names of groups. The model is posed at t afterwards.
  update(session, t, model, shown) {
    model.balance(session, t, this.com, this.dcm, this.ground);
    for (const foot of this.feet) foot.update(session, t, model);
    const bearing = this.feet.filter((foot) => foot.bears);
    for (const [name, parts] of Object.entries(this.groups)) for (const part of parts) part.visible = shown.has(name);
    if (this.feet.length === 0) for (const part of [this.plumb, this.com_spot, this.dcm_spot]) part.visible = false; // it stands on nothing
    for (const foot of this.feet) foot.arrow.visible = foot.dot.visible = foot.bears && shown.has('contacts');
    const over_m = bearing.length > 0 ? Math.min(...bearing.map((foot) => foot.over_m(this.ground))) + lift_m : lift_m;
    const put = ({ x, y }, to = new Vector3()) => to.set(x, y, this.ground.height_m(x, y) + over_m);
    this.com_ball.position.copy(this.com);
    put(this.com, this.com_spot.position);
    put(this.dcm, this.dcm_spot.position);
    for (const spot of [this.com_spot, this.dcm_spot, this.cop_spot, ...this.feet.map((foot) => foot.dot)]) spot.quaternion.copy(this.ground.root.quaternion);
    this.plumb.geometry.setFromPoints([this.com, this.com_spot.position]);
    this.place_cop(bearing, put);
    this.place_support(bearing, model, put);
  }

  place_cop(bearing, put) {
    const total_N = bearing.reduce((sum, foot) => sum + foot.force_N, 0);
    if (total_N <= 0) return (this.cop_spot.visible = false);
    this.cop_spot.position.set(0, 0, 0);
    for (const foot of bearing) this.cop_spot.position.addScaledVector(foot.cop, foot.force_N / total_N);
    put(this.cop_spot.position, this.cop_spot.position);
  }

  place_support(bearing, model, put) {
    const corners = hull(bearing.flatMap((foot) => foot.ground_points(model)));
    if (corners.length < 3) return (this.area.visible = this.outline.visible = false);
    const points = corners.map((corner) => put(corner));
    const fan = [];
    for (let i = 1; i + 1 < points.length; ++i) fan.push(...points[0].toArray(), ...points[i].toArray(), ...points[i + 1].toArray());
    this.area.geometry.setAttribute('position', new Float32BufferAttribute(fan, 3));
    this.outline.geometry.dispose();
    this.outline.geometry = new BufferGeometry().setFromPoints(points);
  }
}
