// The place where the robot stands: light, ground, camera. Draws when told to; knows nothing of time.
import {
  AmbientLight, Color, DirectionalLight, Fog, HemisphereLight, PCFShadowMap, PerspectiveCamera, Scene, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { Ground } from './ground.js';

const themes = {
  light: { back: 0xeef1f4, grid: 0xc9d1d9, lines: 0xdde3e8, paint: 0x8b98a5, sun: 2.1, sky: 1.5, shadow: 0.16 },
  dark: { back: 0x14191f, grid: 0x35404b, lines: 0x232b34, paint: 0xc4ccd4, sun: 1.7, sky: 0.9, shadow: 0.45 },
};

const from_start = new Vector3(2.5, 1.7, 0.62);

const in_software = /swiftshader|llvmpipe|softpipe|software|basic render/i;

function draws_in_software(context) {
  const names = context?.getExtension('WEBGL_debug_renderer_info');
  return Boolean(names) && in_software.test(context.getParameter(names.UNMASKED_RENDERER_WEBGL));
}

// On a canvas of its own, as fine as the machine draws with ease, or as is wanted.
export function make_stage(fine) {
  const canvas = document.createElement('canvas');
  if (fine || !draws_in_software(canvas.getContext('webgl2', { alpha: false, antialias: false }))) return new Stage(document.createElement('canvas'));
  return new Stage(canvas, { fine: false });
}

export class Stage {
  // Not `fine`: no shadows, gloss and smooth edges. A canvas that has a context already keeps it.
  constructor(canvas, { fine = true } = {}) {
    this.fine = fine;
    this.renderer = new WebGLRenderer({ canvas, context: canvas.getContext('webgl2', { alpha: false, antialias: fine }) });
    this.renderer.shadowMap.enabled = fine;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(32, 1, 0.02, 60);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.moved = true; // by hand, since it was drawn
    this.controls.addEventListener('change', () => (this.moved = true));
    this.controls.minDistance = 0.15;
    this.controls.maxDistance = 15;
    this.target = new Vector3(0, 0, 0.6);
    this.distance = 2.7;
    this.from = from_start;
    this.followed = new Vector3();
    this.add_lights();
    this.ground = new Ground(fine);
    this.scene.add(this.ground.root);
    this.look_from_start();
  }

  add_lights() {
    this.sky = new HemisphereLight(0xffffff, 0x8a8f96, 1);
    this.sky.position.set(0, 0, 1);
    this.sun = new DirectionalLight(0xffffff, 2);
    this.sun.castShadow = this.fine;
    this.sun.shadow.mapSize.set(1024, 1024);
    this.sun.shadow.radius = 3;
    this.sun.shadow.bias = -0.0008;
    Object.assign(this.sun.shadow.camera, { left: -1.4, right: 1.4, top: 1.4, bottom: -1.4, near: 0.5, far: 9 });
    this.scene.add(this.sky, this.sun, this.sun.target, new AmbientLight(0xffffff, 0.25));
  }

  set_theme(name) {
    const theme = themes[name];
    this.moved = true;
    this.scene.background = new Color(theme.back);
    this.scene.fog = new Fog(theme.back); // the ground has no edge
    this.ground.set_theme(theme);
    this.sun.intensity = theme.sun;
    this.sky.intensity = theme.sky;
  }

  look_from_start() {
    this.controls.target.copy(this.target);
    this.camera.position.copy(this.target).add(this.from.clone().setLength(this.distance));
    this.controls.update();
    this.moved = true;
  }

  // Sees a robot of this size whole, whose base is at `base`.
  frame(centre, radius, base, from = from_start) {
    this.from = from;
    this.target.copy(centre);
    this.followed.set(base.x, base.y, this.ground.height_m(base.x, base.y));
    this.distance = 4.1 * radius;
    this.look_from_start();
  }

  // Keeps `point` where it is in the picture, sideways; of its height, only what the ground below it rises.
  follow({ x, y }) {
    const ground_m = this.ground.height_m(x, y);
    const way = new Vector3(x, y, ground_m).sub(this.followed);
    this.followed.add(way);
    for (const at of [this.target, this.controls.target, this.camera.position]) at.add(way);
    this.ground.follow(x, y);
    this.sun.target.position.set(x, y, ground_m + 0.4);
    this.sun.position.set(x + 1.2, y + 1.6, ground_m + 4.2);
  }

  resize(width, height, ratio = Math.min(2, globalThis.devicePixelRatio)) {
    if (this.width === width && this.height === height && this.ratio === ratio) return;
    [this.width, this.height, this.ratio] = [width, height, ratio];
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }

  draw() {
    this.controls.update();
    const distance = this.camera.position.distanceTo(this.controls.target);
    Object.assign(this.scene.fog, { near: 1.25 * distance, far: 2.5 * distance });
    this.renderer.render(this.scene, this.camera);
  }

  dispose() {
    this.controls.dispose();
    this.renderer.dispose();
  }
}
