// What is drawn of a scenario's world, by the page and by the page as `kadans render` opens it: soles and things stand on
// the ground that is drawn, wherever that slopes, has edges or is driven.
import { mkdirSync, rmSync, writeFileSync } from 'node:fs';
import { chromium } from 'playwright-core';
import { check, chromium_options, folder, live_address, project, run, start, until } from './program.mjs';

const touching_m = 0.006; // soft contacts and a sole that rolls over its edge

async function record_of(file, name, duration_s) {
  const record = `${folder}/${name}.mcap`;
  const sim = start(['sim', file, '--duration', String(duration_s), '--record', record], /record:/);
  await sim.begun;
  await until(`${record} is there`, () => sim.child.exitCode !== null);
  return record;
}

// Functions for the page. Heights are read from what is in the scene, not from what the page reckons with.
const tools = () => {
  const apply = ({ elements: e }, [x, y, z]) => [0, 1, 2].map((row) => e[row] * x + e[row + 4] * y + e[row + 8] * z + e[row + 12]);
  const inside = ({ elements: e }, at) => [0, 1, 2].map((axis) => [0, 1, 2].reduce((sum, row) => sum + e[4 * axis + row] * (at[row] - e[12 + row]), 0));
  const found = (is) => {
    let part = null;
    globalThis.kadans_stage.scene.traverse((other) => (part ??= is(other) ? other : null));
    return part;
  };
  const boxes_in = (root) => {
    const boxes = [];
    root.traverse((other) => other.geometry?.type === 'BoxGeometry' && boxes.push(other));
    return boxes;
  };
  const corners_of = (box) => {
    const { width, height, depth } = box.geometry.parameters;
    return [-0.5, 0.5].flatMap((x) => [-0.5, 0.5].flatMap((y) => [-0.5, 0.5].map((z) => apply(box.matrixWorld, [x * width, y * height, z * depth]))));
  };
  const ground_m = (x, y) => {
    const e = found((o) => o.name === 'grid').matrixWorld.elements;
    return e[14] - (e[8] * (x - e[12]) + e[9] * (y - e[13])) / e[10];
  };
  // Of the ground and all fixed boxes, whose tops are level.
  const drawn_m = (session, x, y) => {
    let top_m = ground_m(x, y);
    for (const { name } of session.description.world) {
      for (const box of boxes_in(found((o) => o.name === name))) {
        const [east, north] = inside(box.matrixWorld, [x, y, box.matrixWorld.elements[14]]);
        const { width, height, depth } = box.geometry.parameters;
        if (Math.abs(east) <= width / 2 && Math.abs(north) <= height / 2) top_m = Math.max(top_m, box.matrixWorld.elements[14] + depth / 2);
      }
    }
    return top_m;
  };
  // Of each foot that bears: how high its lowest corner is over what is drawn there.
  const soles_over_m = (session) =>
    session.description.robot.feet
      .filter(({ link }) => session.value(`plant.foot.${link}.force_N`) > 30)
      .map(({ link, corners_m }) => {
        const node = found((o) => o.isURDFLink && o.urdfName === link);
        const over_m = corners_m.map((corner) => apply(node.matrixWorld, corner)).map(([x, y, z]) => z - drawn_m(session, x, y));
        return Math.min(...over_m);
      });
  Object.assign(globalThis, { found, boxes_in, corners_of, ground_m, soles_over_m, apply });
};

const loaded = (page) => page.waitForFunction(() => globalThis.kadans?.loading === 0 && globalThis.kadans_drawn?.posed);
const drawn_at = (page, t) =>
  page.evaluate(async (at) => {
    globalThis.kadans.seek(at);
    for (let i = 0; i < 3; ++i) await new Promise((drawn) => requestAnimationFrame(drawn));
  }, t);

async function stands(page, what) {
  const over_m = await page.evaluate(() => soles_over_m(globalThis.kadans));
  check(over_m.length > 0, `${what}: a foot bears`);
  check(over_m.every((m) => Math.abs(m) < touching_m), `${what}: soles are on the ground that is drawn, ${over_m.map((m) => (1000 * m).toFixed(1))} mm over it`);
}

// As the page shows the record, and as `kadans render` lets it be drawn; its pictures are taken here.
async function check_walk(page, name, duration_s, times) {
  const view = start(['view', await record_of(`${project}/config/sweeps/scenarios/${name}.json`, name, duration_s)], /(http:\S+)/);
  const [, url] = await view.begun;
  await page.goto(url);
  await loaded(page);
  for (const t of times) {
    await drawn_at(page, t);
    await stands(page, `${name} at ${t} s`);
  }
  const last = times[times.length - 1];
  await page.goto(new URL(`?record=record.mcap&render=1&at=${last}`, url).href);
  await until('the picture is drawn', () => page.evaluate(() => Boolean(globalThis.kadans_picture)));
  await stands(page, `${name} at ${last} s as kadans render draws it`);
  await view.stop();
}

const things = {
  name: 'things',
  robot: `${project}/config/tulip/robot.json`,
  duration_s: 600,
  world: [
    { kind: 'ground', slope_rad: 0.1, slope_heading_rad: 0.7, motion: { profile: [{ time_s: 0, velocity_m_s: [0, 0, 0] }, { time_s: 1, velocity_m_s: [0.05, 0, 0.1] }, { time_s: 2, velocity_m_s: [0, 0, 0] }] } },
    { kind: 'markings', line_m: 0.05, lines: [{ from_m: [-1, -1], to_m: [1, -1] }, { from_m: [1, -1], to_m: [1, 1] }], arcs: [{ center_m: [0, 0], radius_m: 0.75 }, { center_m: [1, 1], radius_m: 0.5, from_rad: 3.1416, to_rad: 4.7124 }] },
    { kind: 'box', name: 'crate', size_m: [0.3, 0.2, 0.1], position_m: [1.5, 1.5, 0.7], roll_pitch_yaw_rad: [0.9, 0.3, 0.4], mass_kg: 1 },
    { kind: 'wall', name: 'wall', position_m: [-2, 0, -0.3], roll_pitch_yaw_rad: [0, 0, 0.5], width_m: 2, height_m: 1 },
    { kind: 'pendulum', name: 'hit', distance_m: 0.4, position_m: [0, 3, 1] },
    { kind: 'payload', name: 'bag', link: 'torso', point_m: [0, 0, 0.1], mass_kg: 2, from_s: 1, until_s: 3 },
  ],
};

// How far the drawn crate's lowest corner is over the drawn ground.
const crate_over_m = (page) => page.evaluate(() => Math.min(...corners_of(boxes_in(found((o) => o.name === 'crate'))[0]).map(([x, y, z]) => z - ground_m(x, y))));

async function check_things(page, record) {
  const view = start(['view', record], /(http:\S+)/);
  await page.goto((await view.begun)[1]);
  await loaded(page);
  await drawn_at(page, 0.1);
  const carried = () => page.evaluate(() => found((o) => o.name === 'bag').visible);
  check(!(await carried()), 'a payload is not drawn before it is carried');
  check((await crate_over_m(page)) > 0.2, 'a crate is drawn in the air');
  await drawn_at(page, 2);
  check(await carried(), 'a payload is drawn while it is carried');
  await drawn_at(page, 3.9);
  check(!(await carried()), 'and not afterwards');
  const over_m = await crate_over_m(page);
  check(Math.abs(over_m) < touching_m, `a crate that fell lies as it fell, on ground that was driven: ${(1000 * over_m).toFixed(1)} mm over it`);
  const rod_m = await page.evaluate(() => {
    const ends = found((o) => o.name === 'rod of hit').geometry.attributes.position.array;
    return Math.hypot(ends[3] - ends[0], ends[4] - ends[1], ends[5] - ends[2]);
  });
  check(Math.abs(rod_m - 1.5) < 0.01, 'a pendulum hangs from its hinge');
  await view.stop();
}

// Each painted part is where the ground is that is drawn.
const painted_over_m = (page) =>
  page.evaluate(() => found((o) => o.name === 'markings').children.map((part) => {
    const vertices = part.geometry.attributes.position;
    let most_m = 0;
    for (let i = 0; i < vertices.count; ++i) {
      const [x, y, z] = apply(part.matrixWorld, [vertices.getX(i), vertices.getY(i), vertices.getZ(i)]);
      most_m = Math.max(most_m, Math.abs(z - ground_m(x, y)));
    }
    return most_m;
  }));

async function check_live(page, file) {
  const sim = start(['sim', file, '--no-record', '--no-ctl', '--live=0', '--live-token', 'test'], live_address);
  await page.goto((await sim.begun)[1]);
  await until('the robot is drawn', () => page.evaluate(() => globalThis.kadans_drawn?.posed && globalThis.kadans.end_s > 2.5));
  const over_m = await painted_over_m(page);
  check(over_m.length === 4 && over_m.every((m) => m < 0.004), 'a live run: lines and arcs lie on the ground that slopes');
  await page.click('[role=tab]:has-text("World")');
  const count = (what) => page.locator(`.world-map ${what}`).count();
  await until('the world from above has its lines', async () => (await count('.markings line')) === 2 && (await count('.markings circle')) === 1 && (await count('.markings path')) === 1);
  const driven = await page.evaluate(() => document.querySelector('.world-map .markings').getAttribute('transform').match(/[-\d.]+/g).map(Number));
  check(Math.abs(driven[0] - 0.05) < 0.002 && Math.abs(driven[1]) < 0.002, 'they are there where the ground was driven');
  const wall = await page.evaluate(() => document.querySelectorAll('.world-map polygon.thing')[1].getAttribute('points').split(' ').map((at) => at.split(',').map(Number)));
  const [[x0, y0], [x1, y1]] = wall;
  const along = Math.abs(((Math.atan2(y1 - y0, x1 - x0) - 0.5) * 2) / Math.PI);
  check(wall.length === 4 && Math.abs(along - Math.round(along)) < 0.01, 'and a wall is turned as it stands');
  await sim.stop();
}

// A robot whose links have shapes to touch with, and one of them a picture of its own.
const shapes = `<robot name="shapes">
  <link name="base"><inertial><mass value="2"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>
    <collision><origin xyz="0 0 0.1"/><geometry><box size="0.3 0.2 0.1"/></geometry></collision></link>
  <link name="arm"><inertial><mass value="0.2"/><inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.001"/></inertial>
    <visual><geometry><sphere radius="0.05"/></geometry></visual>
    <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <joint name="elbow" type="revolute"><parent link="base"/><child link="arm"/><origin xyz="0 0 0.3"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="5" velocity="5"/></joint>
</robot>`;

async function check_shapes(page) {
  const made_in = `${folder}/shapes`;
  rmSync(made_in, { recursive: true, force: true }); // of an earlier run
  mkdirSync(made_in);
  writeFileSync(`${made_in}/from.urdf`, shapes);
  const made = start(['new', 'robot', `${made_in}/from.urdf`, '--no-run', '--in', made_in], /behaviors/);
  await made.begun;
  await until('the robot is written', () => made.child.exitCode !== null);
  const view = start(['view', await record_of(`${made_in}/config/scenarios/shapes_hold.json`, 'shapes', 0.1)], /(http:\S+)/);
  await page.goto((await view.begun)[1]);
  await loaded(page);
  const drawn = (link) => page.evaluate((name) => {
    const kinds = [];
    found((o) => o.isURDFLink && o.urdfName === name).children.forEach((part) => part.isURDFVisual && part.traverse((o) => o.isMesh && kinds.push(o.geometry.type)));
    return kinds.join();
  }, link);
  check((await drawn('base')) === 'BoxGeometry', 'a link without a picture is drawn as what it touches with');
  check((await drawn('arm')) === 'SphereGeometry', 'a link with a picture is drawn as that alone');
  await view.stop();
}

run(async () => {
  const file = `${folder}/things.json`;
  writeFileSync(file, JSON.stringify(things));
  const browser = await chromium.launch(chromium_options);
  const context = await browser.newContext({ viewport: { width: 900, height: 600 } });
  context.setDefaultTimeout(0); // a busy machine draws slowly; run() bounds all of it
  await context.addInitScript(tools);
  const page = await context.newPage();
  const problems = [];
  await page.route('**/frames/**', (route) => route.fulfill({ status: 200 }));
  page.on('pageerror', (error) => problems.push(error.stack));
  await check_walk(page, 'walk_up_slope', 6, [1, 5.5]);
  await check_walk(page, 'walk_off_edge', 6, [1, 5.5]);
  await check_walk(page, 'walk_over_tiles', 5, [4.5]);
  await check_things(page, await record_of(file, 'things', 4));
  await check_live(page, file);
  await check_shapes(page);
  check(problems.length === 0, `the page has no error ${problems.join('\n')}`);
});
