// Pictures of every view of the page, to be looked at by a person: run.sh FOLDER KADANS PROJECT pictures; they land in
// FOLDER/pictures. PICTURES=word takes only those whose name holds the word.
import { existsSync, mkdirSync, writeFileSync } from 'node:fs';
import { chromium } from 'playwright-core';
import { chromium_options, folder, live_address, project, run, scenario, start, until } from './program.mjs';

const out = `${folder}/pictures`;
const sizes = { laptop: { width: 1366, height: 768 }, screen: { width: 1920, height: 1080 } };
const tabs = ['behavior', 'parameters', 'safety', 'timing', 'log', 'world'];
const wanted = process.env.PICTURES ?? '';
let browser;

async function record(name, file, more = []) {
  if (!existsSync(file)) {
    const sim = start(['sim', scenario(name), '--record', file, ...more], /record:/);
    await sim.begun;
    await until('the record is there', () => sim.child.exitCode !== null);
  }
  return file;
}

// A page of its own: nothing that an earlier one kept.
async function open(url, { size = 'laptop', theme = 'light', tab = 0 } = {}) {
  const context = await browser.newContext({ viewport: sizes[size] });
  const page = await context.newPage();
  page.on('pageerror', (error) => console.log(`error ${url}: ${error.stack}`));
  const address = new URL(url);
  address.searchParams.set('theme', theme);
  address.searchParams.set('tab', tab);
  address.searchParams.set('fine', '');
  await page.goto(address.href);
  return page;
}

async function take(page, name) {
  await page.waitForTimeout(400);
  await page.screenshot({ path: `${out}/${name}.png` });
  console.log(`${out}/${name}.png`);
}

const read = (page) => page.waitForFunction(() => globalThis.kadans?.loading === 0);
const seek = (page, t) => page.evaluate((at) => globalThis.kadans.seek(at), t);

// name -> how it is taken; many want a server of their own kind.
const views = {
  async record() {
    const view = start(['view', await record('get_up_supine', `${folder}/get_up.mcap`)], /(http:\S+)/);
    const [, url] = await view.begun;
    for (const size of Object.keys(sizes)) {
      for (const theme of ['light', 'dark']) {
        for (const [tab, name] of tabs.entries()) {
          if (size === 'screen' && tab > 0) continue;
          const page = await open(url, { size, theme, tab });
          await read(page);
          await seek(page, 4.6);
          if (name === 'parameters') await page.click('.group .topic >> nth=0');
          await take(page, `record-${name}-${size}-${theme}`);
          await page.context().close();
        }
      }
    }
    await view.stop();
  },
  async robots() {
    for (const name of ['gaze_pursuit', 'jiwiy_sine']) {
      const view = start(['view', await record(name, `${folder}/${name}.mcap`)], /(http:\S+)/);
      const page = await open((await view.begun)[1], { theme: 'dark' });
      await read(page);
      await seek(page, 3);
      await take(page, `robot-${name}`);
      await page.context().close();
      await view.stop();
    }
  },
  async states() {
    const view = start(['view', await record('squat', `${folder}/squat.mcap`)], /(http:\S+)/);
    const [, url] = await view.begun;
    const at = (query) => new URL(`/?${query}`, url).href;
    writeFileSync(`${folder}/bad.mcap`, 'this is no record');
    for (const [name, address] of [['empty', at('empty')], ['address-wrong', at('record=nowhere.mcap')], ['address-unreachable', at('record=http://127.0.0.1:9/x.mcap')], ['nothing-runs', at('')]]) {
      const page = await open(address);
      await page.waitForTimeout(700);
      await take(page, `state-${name}`);
      await page.context().close();
    }
    const page = await open(url, { theme: 'dark' });
    await read(page);
    const chooser = page.waitForEvent('filechooser');
    await page.click('text=Open record…');
    await (await chooser).setFiles(`${folder}/bad.mcap`);
    await page.waitForSelector('.start .error');
    await take(page, 'state-damaged');
    await page.goto(url);
    await read(page);
    await page.keyboard.press('?');
    await take(page, 'state-keys');
    await page.keyboard.press('Escape');
    for (let i = 0; i < 3; ++i) await page.keyboard.press('Tab');
    await take(page, 'state-focus');
    await page.keyboard.press('/');
    await page.keyboard.type('knee position');
    await take(page, 'state-find');
    await page.context().close();
    await view.stop();
  },
  async gaze() {
    const head = start(['run', `${project}/config/head/robot.json`, '--soft', '--no-ctl', '--live=0'], live_address);
    const page = await open((await head.begun)[1], { theme: 'dark' });
    await until('rows', () => page.evaluate(() => globalThis.kadans.end_s > 2));
    await take(page, 'live-gaze');
    await page.context().close();
    await head.stop();
  },
  async live() {
    const sim = start(['sim', scenario('squat'), '--play', 'squat{repeats=100}', '--duration', '600', '--live=0', '--no-record', '--no-ctl'], live_address);
    const [, url, port] = await sim.begun;
    const reader = await open(`http://127.0.0.1:${port}/`, { theme: 'dark', tab: 1 });
    await until('rows', () => reader.evaluate(() => globalThis.kadans.end_s > 1));
    await take(reader, 'live-without-token');
    await reader.context().close(); // one at a time: all is drawn in software
    const page = await open(url);
    await until('rows', () => page.evaluate(() => globalThis.kadans.end_s > 4));
    await take(page, 'live-behavior');
    await page.keyboard.press('2');
    await page.fill('[placeholder="Find a parameter"]', 'knee.k');
    await page.locator('.parameter input[type=range]').first().focus();
    await page.keyboard.press('PageUp');
    await take(page, 'live-parameters');
    await page.keyboard.press('Escape');
    await page.keyboard.press('4');
    await take(page, 'live-timing');
    await page.click('.estop');
    await page.keyboard.press('3');
    await page.waitForTimeout(1500);
    await take(page, 'live-estop');
    await page.keyboard.press('5');
    await take(page, 'live-log');
    await sim.stop();
    await take(page, 'live-lost');
    await page.keyboard.press('t');
    await take(page, 'live-lost-dark');
  },
};

run(async () => {
  mkdirSync(out, { recursive: true });
  browser = await chromium.launch(chromium_options);
  for (const [name, view] of Object.entries(views)) if (name.includes(wanted)) await view();
});
