// The robot from its URDF, posed from the signals of a session: joints as measured, the base as the model knows it or,
// on a real robot, as it is estimated. Also its centre of mass, from the inertias of the same URDF.
import { Box3, BoxGeometry, Euler, Group, Mesh, MeshLambertMaterial, Quaternion, Sphere, Vector3 } from 'three';
import URDFLoader from 'urdf-loader';

const gravity_m_s2 = 9.81;
const numbers = (text) => (text ?? '0 0 0').trim().split(/\s+/).map(Number);

function masses_of(robot) {
  const masses = [];
  for (const link of Object.values(robot.links)) {
    const inertial = [...(link.urdfNode?.children ?? [])].find((child) => child.nodeName === 'inertial');
    const mass = inertial?.querySelector('mass');
    if (!mass) continue;
    const origin = inertial.querySelector('origin')?.getAttribute('xyz');
    masses.push({ link, kg: Number(mass.getAttribute('value')), at: new Vector3(...numbers(origin)) });
  }
  return masses;
}

// A link without a picture of its own is drawn as what it touches with. Models in the making have no more, often.
function with_shapes(urdf) {
  const xml = new DOMParser().parseFromString(urdf, 'text/xml');
  for (const link of xml.querySelectorAll('robot > link')) {
    const of_kind = (kind) => [...link.children].filter((child) => child.nodeName === kind);
    if (of_kind('visual').length > 0) continue;
    for (const collision of of_kind('collision')) {
      const visual = xml.createElement('visual');
      for (const part of [...collision.children]) visual.append(part.cloneNode(true));
      link.append(visual);
    }
  }
  return xml;
}

const meshes_at = './asset/'; // by the names that the URDF has for them, with package:// or without

// In place of a mesh that is not there, or of a kind that nothing here reads. Whatever that mesh's scale is.
const marker_m = 0.05;
function mark(material, done) {
  const marker = new Mesh(new BoxGeometry(marker_m, marker_m, marker_m), material ?? new MeshLambertMaterial());
  done(marker);
  if (marker.parent) marker.scale.set(1, 1, 1).divide(marker.parent.scale);
}

export class RobotModel {
  // Not `fine`: without gloss. `prefix`: with which the robot's signals begin.
  constructor(urdf, fine, prefix = '') {
    this.prefix = prefix;
    const loader = new URDFLoader();
    loader.packages = (name) => `${meshes_at}${name}`;
    loader.workingPath = meshes_at; // of names that are relative to the URDF
    const meshes = [];
    loader.loadMeshCb = (path, manager, material, done) => {
      const come = (resolve) => {
        const take = (mesh) => resolve(mesh ? done(mesh) : mark(material, done));
        if (/\.(stl|dae)$/i.test(path)) loader.defaultMeshLoader(path, manager, material, take);
        else take(null);
      };
      meshes.push(new Promise(come));
    };
    this.robot = loader.parse(with_shapes(urdf));
    this.root = new Group();
    this.root.add(this.robot);
    this.joints = Object.values(this.robot.joints).filter((joint) => joint.jointType !== 'fixed');
    this.masses = masses_of(this.robot);
    this.turn = new Quaternion();
    this.euler = new Euler();
    this.finish(fine);
    // When its meshes are there, too; undefined when it has none.
    this.complete = meshes.length > 0 ? Promise.all(meshes).then(() => this.finish(fine)) : undefined;
  }

  finish(fine) {
    for (const joint of this.joints) joint.setJointValue(0);
    this.radius = this.bounds().radius; // with all joints at 0
    this.robot.traverse((part) => {
      if (!part.isMesh) return;
      part.castShadow = true;
      part.receiveShadow = true;
      const { isMeshPhongMaterial, color, map, opacity, transparent } = part.material;
      if (isMeshPhongMaterial && !fine) {
        part.material = new MeshLambertMaterial({ color, map, opacity, transparent });
      } else if (isMeshPhongMaterial) {
        part.material.shininess = 18;
        part.material.specular?.setHex(0x222222);
      }
    });
  }

  // A ball around the robot as it is posed now.
  bounds() {
    const sphere = new Box3().setFromObject(this.robot).getBoundingSphere(new Sphere());
    if (!(sphere.radius > 0)) sphere.set(this.root.position.clone(), 0.5);
    return sphere;
  }

  link(name) {
    return this.robot.links[name];
  }

  pose(session, t) {
    const value_of = (name) => session.value(this.prefix + name, t);
    for (const joint of this.joints) {
      const position = value_of(`joint.${joint.name}.position_rad`);
      if (Number.isFinite(position)) joint.setJointValue(position);
    }
    const or = (first, second, last) => {
      const value = value_of(first);
      if (Number.isFinite(value)) return value;
      const other = second ? value_of(second) : NaN;
      return Number.isFinite(other) ? other : last;
    };
    this.root.position.set(
      or('plant.base.x_m', null, 0),
      or('plant.base.y_m', null, 0),
      or('plant.base.height_m', 'base.height_m', 0.9),
    );
    const yaw = or('plant.base.yaw_rad', 'base.yaw_rad', 0);
    this.euler.set(or('base.roll_rad', null, 0), or('base.pitch_rad', null, 0), yaw, 'ZYX');
    this.root.quaternion.setFromEuler(this.euler);
    this.root.updateMatrixWorld(true);
  }

  // As it is posed now.
  centre_of_mass(to) {
    const part = new Vector3();
    let kg = 0;
    to.set(0, 0, 0);
    for (const mass of this.masses) {
      to.addScaledVector(part.copy(mass.at).applyMatrix4(mass.link.matrixWorld), mass.kg);
      kg += mass.kg;
    }
    return kg > 0 ? to.divideScalar(kg) : to;
  }

  // Centre of mass and divergent component of motion (its place plus its speed over the pendulum's rate); leaves the
  // robot posed at t.
  balance(session, t, com, dcm, ground) {
    const dt_s = 0.02;
    const before = new Vector3();
    const first = session.start_s;
    this.pose(session, Math.max(first, t - dt_s));
    this.centre_of_mass(before);
    this.pose(session, t);
    this.centre_of_mass(com);
    const passed_s = Math.min(dt_s, t - first);
    dcm.copy(com).setZ(0);
    const height_m = com.z - ground.height_m(com.x, com.y);
    if (passed_s <= 0 || height_m <= 0.05) return;
    const per_rate = Math.sqrt(height_m / gravity_m_s2) / passed_s;
    dcm.x += (com.x - before.x) * per_rate;
    dcm.y += (com.y - before.y) * per_rate;
  }
}
