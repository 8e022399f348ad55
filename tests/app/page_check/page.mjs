// The page in a real browser: a live run, then its record.
import { existsSync, readdirSync, statSync, writeFileSync } from 'node:fs';
import { chromium } from 'playwright-core';
import { WebSocket } from 'ws';
import { check_forms } from './forms.mjs';
import { check_between, check_files, check_keyboard, check_plots, check_tabs, check_theme } from './hands.mjs';
import { check, chromium_options, folder, live_address, project, run, scenario, start, until } from './program.mjs';

const page_max_bytes = 300 * 1024;

// The robot's picture as a hash, to tell whether it changed.
const picture = (page) =>
  page.evaluate(() => {
    const small = document.createElement('canvas');
    small.width = small.height = 96;
    const context = small.getContext('2d');
    globalThis.kadans_stage.draw(); // what was drawn is gone once the screen has it
    context.drawImage(document.getElementById('robot'), 0, 0, 96, 96);
    return context.getImageData(0, 0, 96, 96).data.reduce((hash, value) => (Math.imul(hash, 31) + value) | 0, 7);
  });
const value = (page, name) => page.evaluate((signal) => globalThis.kadans.value(signal), name);
const active = (page) => page.evaluate(() => document.querySelector('.chart .state.active')?.dataset.state ?? '');

// As the runtime tells it to a client that asked for nothing else.
const parameter = (port, name) =>
  new Promise((resolve, reject) => {
    const socket = new WebSocket(`ws://127.0.0.1:${port}/`, ['foxglove.sdk.v1']);
    socket.on('error', reject);
    socket.on('open', () => socket.send(JSON.stringify({ op: 'getParameters', parameterNames: [name] })));
    socket.on('message', (data, binary) => {
      const told = binary ? {} : JSON.parse(data);
      if (told.op !== 'parameterValues') return;
      socket.close();
      resolve(told.parameters[0]?.value);
    });
  });

function check_size() {
  const assets = `${project}/web/dist/assets`;
  const bytes = readdirSync(assets).filter((file) => file.endsWith('.gz')).reduce((sum, file) => sum + statSync(`${assets}/${file}`).size, 0);
  check(bytes < page_max_bytes, `the page is ${bytes} bytes compressed, under ${page_max_bytes}`);
}

async function check_live(page, port) {
  await page.waitForSelector('.chart .state');
  check(true, 'it loads and draws the chart');
  await until('the robot squats', async () => (await active(page)) === 'squat');
  check(true, 'it follows a transition');
  const knee = await value(page, 'joint.l_knee.position_rad');
  const drawn = await picture(page);
  await until('a joint moves, as a number', async () => Math.abs((await value(page, 'joint.l_knee.position_rad')) - knee) > 0.05);
  await until('and in the picture', async () => (await picture(page)) !== drawn);
  check(true, 'joints move, in numbers and pixels');

  await page.click('[role=tab]:has-text("Parameters")');
  await page.fill('[placeholder="Find a parameter"]', 'l_knee.kp');
  const slider = page.locator('[data-parameter="posture.l_knee.kp_Nm_per_rad"] input[type=range]');
  const before = await page.evaluate(() => globalThis.kadans.parameters.get('posture.l_knee.kp_Nm_per_rad'));
  await slider.focus();
  await page.keyboard.press('PageUp');
  await until('another client sees it', async () => (await parameter(port, 'posture.l_knee.kp_Nm_per_rad')) > before);
  check(true, 'a slider changes the parameter in the runtime');
}

// The chart: whole over the page, enlarged by the wheel, and what a transition waits for.
async function check_chart(page) {
  await until('the title names the active state', async () => (await page.title()).startsWith('squat in '));
  check((await page.locator('.bar .lane[data-behavior="squat"] .band').count()) > 0, 'the bar has a row for the behavior');
  await page.click('[role=tab]:has-text("Behavior")');
  const shown = () =>
    page.evaluate(() => {
      const box = document.querySelector('.chart-box').getBoundingClientRect();
      const states = [...document.querySelectorAll('.chart .state')].map((state) => state.getBoundingClientRect());
      return { all: states.every((r) => r.left >= box.left && r.right <= box.right && r.top >= box.top && r.bottom <= box.bottom), width: states[0].width, page: box.width / innerWidth };
    });
  await page.click('.chart-tools button:has-text("Wide")');
  await page.click('.chart-tools button:has-text("All")');
  await until('all of it is seen over the whole page', async () => ((now) => now.all && now.page > 0.9)(await shown()));
  const { width } = await shown();
  await page.hover('.chart-box');
  await page.mouse.wheel(0, -600);
  await until('the wheel enlarges it', async () => (await shown()).width > 1.3 * width);
  await page.keyboard.press('Escape');
  await page.click('.chart-tools button:has-text("Close")');
  await until('it is back in its panel', async () => (await shown()).page < 0.5);
  check(true, 'the chart fits over the page, and is enlarged');
  const number = await page.evaluate(() => globalThis.kadans.description.behaviors[0].chart.transitions.find((transition) => transition.guard)?.number);
  await page.locator(`.edge[data-transition="${number}"]`).focus();
  await until('its guard is shown', () => page.evaluate(() => /function/.test(document.querySelector('.transition-card pre')?.textContent ?? '')));
  await until('why it is not taken', () => page.evaluate(() => /the guard gives false/.test(document.querySelector('.transition-card .held')?.textContent ?? '')));
  await page.evaluate(() => document.activeElement.blur());
  check(true, 'a transition shows its guard and why it is not taken');
}

// Where something of the scene is on the screen, two frames from now: `found` is a predicate on three.js's objects, as
// text. Null: nothing that is seen is it.
const place_now = (page, found) =>
  page.evaluate(async (text) => {
    for (let i = 0; i < 2; ++i) await new Promise((drawn) => requestAnimationFrame(drawn));
    const { scene, camera, renderer } = globalThis.kadans_stage;
    let part = null;
    scene.traverseVisible((other) => (part ??= new Function('o', `return ${text}`)(other) ? other : null));
    if (!part) return null;
    const at = part.getWorldPosition(camera.position.clone()).project(camera);
    const box = renderer.domElement.getBoundingClientRect();
    return { x: box.x + (box.width * (at.x + 1)) / 2, y: box.y + (box.height * (1 - at.y)) / 2 };
  }, found);

// When it stands still there: a hand that aims at where it was misses.
async function place_of(page, found) {
  let last = null;
  return until(`${found} stands still on the screen`, async () => {
    const [before, now] = [last, await place_now(page, found)];
    last = now;
    return before && now && Math.hypot(now.x - before.x, now.y - before.y) < 0.5 ? now : null;
  });
}

async function drag(page, from, dx, dy) {
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  for (let i = 1; i <= 5; ++i) await page.mouse.move(from.x + (dx * i) / 5, from.y + (dy * i) / 5);
  await page.mouse.up();
}

async function check_hand(page) {
  await page.keyboard.press('Escape');
  await page.keyboard.down('Shift');
  await drag(page, await place_of(page, "o.isURDFLink && o.urdfName === 'torso'"), 0, 25);
  await page.keyboard.up('Shift');
  await until('the push is logged', () => page.evaluate(() => globalThis.kadans.log.some((line) => line.message.startsWith('push torso='))));
  check(true, 'the mouse pushes a link');
  await page.fill('[aria-label="Behaviors to play"]', 'wave');
  await page.click('.play-list button');
  await until('its chart comes', () => page.evaluate(() => globalThis.kadans.description.behaviors.some((behavior) => behavior.name === 'wave')));
  check(true, 'another behavior is played, and its chart is shown');
}

async function check_gaze(page) {
  const still = `${folder}/still.json`; // on virtual time: a busy machine makes no tick late, which would hold the joints
  writeFileSync(still, JSON.stringify({ name: 'still', robot: `${project}/config/head/robot.json`, duration_s: 600 }));
  const head = start(['sim', still, '--no-record', '--no-ctl', '--live=0', '--live-token', 'test'], live_address);
  await page.goto((await head.begun)[1]);
  const target = () => value(page, 'control.gaze.target_z_m');
  await until('the robot is drawn', () => page.evaluate(() => globalThis.kadans_drawn?.robot && globalThis.kadans.end_s > 0.5));
  // The eyes jump, then the neck follows and they turn back: what stays is the sum.
  const tilt = async () => (await Promise.all(['lower_tilt', 'upper_tilt', 'eye_tilt'].map((joint) => value(page, `joint.${joint}.position_rad`)))).reduce((sum, rad) => sum + rad);
  const [before, level] = [await target(), await tilt()];
  // As a hand does: it goes to the target until the page says that there is something to take.
  const taken = await until('the target can be taken', async () => {
    const at = await place_of(page, "o.name === 'gaze target'");
    await page.mouse.move(at.x, at.y);
    return (await page.evaluate(() => globalThis.kadans_stage.renderer.domElement.style.cursor)) === 'grab' ? at : null;
  });
  await drag(page, taken, 0, -40);
  await until('the target is higher', async () => (await target()) > before + 0.05);
  await until('the eyes look higher', async () => (await tilt()) < level - 0.02);
  check(true, 'the mouse leads the gaze');
  await head.stop();
}

async function check_record(page, record) {
  const view = start(['view', record], /(http:\S+)/);
  const [, url] = await view.begun;
  await page.goto(url);
  await page.waitForFunction(() => globalThis.kadans?.loading === 0 && globalThis.kadans.end_s > 2.5);
  const bar = await page.locator('.bar').boundingBox();
  const go = async (share) => {
    await page.mouse.click(bar.x + share * bar.width, bar.y + bar.height / 2);
    return page.evaluate(() => globalThis.kadans.cursor_s);
  };
  const end_s = await page.evaluate(() => globalThis.kadans.end_s);
  const between_s = await page.evaluate((clientX) => {
    const whole_s = kadans.end_s;
    kadans.end_s = whole_s / 2; // more or less of it is there than when the bar was drawn
    document.querySelector('.bar').dispatchEvent(new PointerEvent('pointerdown', { buttons: 1, pointerId: 1, clientX, bubbles: true }));
    kadans.end_s = whole_s;
    return kadans.cursor_s;
  }, bar.x + 0.5 * bar.width);
  check(Math.abs(between_s - 0.25 * end_s) < 0.05 * end_s, 'the bar goes by the time that there is, not by the one that it shows');
  const early_s = await go(0.1);
  await until('an early picture', async () => (await active(page)) === 'settle');
  const [knee, drawn] = [await value(page, 'joint.l_knee.position_rad'), await picture(page)];
  const late_s = await go(0.9);
  check(Math.abs(early_s - 0.1 * end_s) < 0.05 * end_s && Math.abs(late_s - 0.9 * end_s) < 0.05 * end_s, 'the bar goes to the time that is clicked');
  check(Math.abs((await value(page, 'joint.l_knee.position_rad')) - knee) > 0.2, 'the joints are those of that time');
  await until('and the picture is', async () => (await picture(page)) !== drawn);
  await until('and the state', async () => (await active(page)) === 'squat');
  check(true, 'a record is scrubbed: numbers, picture and state follow');
  await view.stop();
}

run(async () => {
  check_size();
  const record = `${folder}/page.mcap`;
  const sim = (port) => start(['sim', scenario('squat'), '--play', 'squat{repeats=100}', '--duration', '600', `--live=${port}`, '--live-token', 'test', '--no-record', '--no-ctl'], live_address);
  const recorded = start(['sim', scenario('squat'), '--duration', '3', '--record', record], /record:/);
  await recorded.begun;
  await until('the record is there', () => recorded.child.exitCode !== null && existsSync(record));

  const first = sim(0);
  const [, url, port] = await first.begun;
  const browser = await chromium.launch(chromium_options);
  // Software draws: a quarter of the pixels takes a fifth of the time from the whole check.
  const context = await browser.newContext({ viewport: { width: 1100, height: 640 }, deviceScaleFactor: 0.5 });
  context.setDefaultTimeout(0); // a busy machine draws slowly; run() bounds all of it
  const page = await context.newPage();
  const problems = [];
  const watch = (other) => other.on('pageerror', (error) => problems.push(error.stack));
  watch(page);
  await page.goto(url);
  await check_live(page, port);
  await check_chart(page);
  await check_hand(page);
  await check_plots(page);
  await check_between(page, problems);
  await check_theme(page);
  await check_keyboard(page);

  await check_tabs(context, url, watch);

  const id = await page.evaluate(() => globalThis.kadans.id);
  await first.stop();
  await until('the page sees that it is gone', () => page.evaluate(() => globalThis.kadans.status !== ''));
  const second = sim(port);
  await second.begun;
  await until('it connects again', () => page.evaluate((was) => globalThis.kadans.status === '' && globalThis.kadans.id !== was, id));
  const end_s = await page.evaluate(() => globalThis.kadans.end_s);
  await until('values come again', () => page.evaluate((was) => globalThis.kadans.end_s > was && globalThis.kadans.end_s < 60, end_s));
  check(true, 'it connects again after the server was away');
  await second.stop();

  await check_record(page, record);
  await check_files(page, record);
  await check_gaze(page);
  await check_forms(page);
  check(problems.length === 0, `the page has no error ${problems.join('\n')}`);
});
