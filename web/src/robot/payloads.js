// What the robot carries: a ball at the link that bears it, as large as so much of something twice as heavy as water, while
// it is carried.
import { Mesh, MeshLambertMaterial, SphereGeometry } from 'three';

const color = 0x9b6b43;
const density_kg_m3 = 2000;

export class Payloads {
  constructor(payloads, model) {
    this.balls = payloads.filter(({ link }) => model.link(link)).map(({ name, link, point_m, mass_kg, from_s, until_s }) => {
      const ball = new Mesh(new SphereGeometry(Math.cbrt((3 * mass_kg) / (4 * Math.PI * density_kg_m3)), 24, 16), new MeshLambertMaterial({ color }));
      ball.name = name;
      ball.castShadow = true;
      ball.position.set(...point_m);
      model.link(link).add(ball);
      return { ball, from_s, until_s: until_s ?? Infinity };
    });
  }

  update(t) {
    for (const { ball, from_s, until_s } of this.balls) ball.visible = t >= from_s && t < until_s;
  }
}
