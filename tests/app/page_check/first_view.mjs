// How soon the page shows a live run, and how often it is brought up to date: medians over fresh browser profiles, on
// the loopback. The first view ends when the robot stands drawn in the posture that the run told, and the picture is
// finished: pixels are read back. It begins with the navigation, in a window that is open already.
// The last line is one object {key: {text, value, unit}}. Chromium draws in software here, so the rate of pictures is the
// machine's; rows come beside it.
import { readdirSync, statSync } from 'node:fs';
import { chromium } from 'playwright-core';
import { chromium_options, live_address, project, run, scenario, start, until } from './program.mjs';

const views = 7;
const watched_s = 5;
const window_opens_ms = 2000; // Chromium's own pages
const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];

// In the page, before anything else of it.
const watch_for_robot = () => {
  const look = () => {
    if (!globalThis.kadans_drawn?.posed) return requestAnimationFrame(look);
    const gl = document.getElementById('robot').getContext('webgl2');
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    globalThis.first_view_ms = performance.now();
  };
  requestAnimationFrame(look);
};

// Counts what comes and what is drawn in the next seconds.
const count_updates = async (seconds) => {
  const { kadans, kadans_drawn } = globalThis;
  const joint = kadans.topics.get('/joint');
  const [rows, pictures, began] = [joint.seen, kadans_drawn.pictures, performance.now()];
  await new Promise((resolve) => setTimeout(resolve, 1000 * seconds));
  const s = (performance.now() - began) / 1000;
  return { rows: (joint.seen - rows) / s, pictures: (globalThis.kadans_drawn.pictures - pictures) / s };
};

async function view(browser, url) {
  const context = await browser.newContext({ viewport: { width: 1366, height: 768 } });
  const page = await context.newPage();
  await page.addInitScript(watch_for_robot);
  await page.waitForTimeout(window_opens_ms);
  await page.goto(url);
  await until('the robot is drawn', () => page.evaluate(() => globalThis.first_view_ms > 0));
  const first_ms = await page.evaluate(() => globalThis.first_view_ms);
  const updates = await page.evaluate(count_updates, watched_s);
  await context.close();
  return { first_ms, ...updates };
}

function compressed_bytes() {
  const assets = `${project}/web/dist/assets`;
  return readdirSync(assets).filter((file) => file.endsWith('.gz')).reduce((sum, file) => sum + statSync(`${assets}/${file}`).size, 0);
}

run(async () => {
  const live = start(['run', `${project}/config/tulip/robot.json`, '--play', 'squat{repeats=100}', '--soft', '--no-ctl', '--live=0'], live_address);
  const [, url] = await live.begun;
  const browser = await chromium.launch(chromium_options);
  const seen = [];
  for (let i = 0; i < views; ++i) seen.push(await view(browser, url));
  const of = (key) => median(seen.map((one) => one[key]));
  const figure = (text, value, unit) => ({ text, value, unit });
  console.log(JSON.stringify({
    first_view_ms: figure('page asked for to robot drawn', of('first_ms'), 'ms'),
    rows_per_s: figure('rows a second that the page got', of('rows'), '1/s'),
    pictures_per_s: figure('pictures a second that it drew, in software', of('pictures'), '1/s'),
    compressed_kb: figure('page, compressed', compressed_bytes() / 1024, 'KB'),
  }));
});
