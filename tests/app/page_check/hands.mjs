// What hands do with the page besides looking: drag signals, drop and open records, switch the theme, work by keyboard.
import { check, start, until, within } from './program.mjs';

const plots = (page) => page.evaluate(() => [...document.querySelectorAll('.plot')].map((plot) => [...plot.querySelectorAll('.series')].map((series) => series.firstElementChild.nextSibling.textContent)));

// The signals of the first plot, drawn: how many pixels of its canvas are not empty.
const inked = (page, at) =>
  page.evaluate((index) => {
    const canvas = document.querySelectorAll('.plot canvas')[index];
    const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    let inks = 0;
    for (let i = 3; i < data.length; i += 4) inks += data[i] > 0 ? 1 : 0;
    return inks;
  }, at);

export async function check_plots(page) {
  const name = 'joint.l_hip_pitch.position_rad';
  await page.click('.signals .topic:has-text("joint")');
  const signal = page.locator(`[data-signal="${name}"]`);
  const before = await plots(page);
  await signal.dragTo(page.locator('.plot').first());
  await until('the plot has it', async () => (await plots(page))[0].includes(name));
  check((await plots(page))[0].length === before[0].length + 1, 'a signal is dragged into a plot');
  await page.click(`[aria-label="Remove ${name}"]`);
  await signal.focus();
  await page.keyboard.press('Enter');
  await until('the last plot has it', async () => (await plots(page)).at(-1).includes(name));
  await until('it is drawn', async () => (await inked(page, (await plots(page)).length - 1)) > 500);
  check(true, 'Enter puts one into the newest plot, and it is drawn');
  await page.click('.signals .topic:has-text("joint")');
}

export async function check_theme(page) {
  const theme = () => page.evaluate(() => [document.documentElement.dataset.theme, getComputedStyle(document.body).backgroundColor]);
  const [name, color] = await theme();
  await page.keyboard.press('Escape');
  await page.keyboard.press('t');
  await until('the theme is another', async () => (await theme())[0] !== name && (await theme())[1] !== color);
  await page.click('[title="Dark or light (t)"]');
  await until('and is back', async () => (await theme())[0] === name && (await theme())[1] === color);
  check(true, 'the theme switches by key and button');
}

// Tabs on until what has the focus fits; on a busy machine the page may have lost the run for a moment, and it is disabled.
async function tab_to(page, selector) {
  await page.waitForSelector(`${selector}:enabled`);
  for (let i = 0; i < 80; ++i) {
    if (await page.evaluate((wanted) => document.activeElement?.matches(wanted), selector)) return;
    await page.keyboard.press('Tab');
  }
  throw new Error(`the tab key does not lead to ${selector}`);
}

// No mouse: plays, stops and ends a run in the emergency stop.
export async function check_keyboard(page) {
  const last = (behavior) => page.evaluate((name) => globalThis.kadans.last_transitions().get(name)?.to, behavior);
  const logged = (words) => page.evaluate((text) => globalThis.kadans.log.some((line) => line.message.includes(text)), words);
  await page.keyboard.press('Escape');
  await tab_to(page, '[aria-label="Behaviors to play"]');
  await page.keyboard.type('squat{repeats=3}');
  await page.keyboard.press('Enter');
  await until('squat begins', async () => Boolean(await last('squat')));
  await until('the field is empty again', () => page.evaluate(() => document.activeElement.value === ''));
  await tab_to(page, '[data-verb="stop"]');
  await page.keyboard.press('Enter');
  await until('the run says that it stops', () => logged('stop'));
  await page.keyboard.press('Escape');
  await page.keyboard.press('3');
  await page.waitForSelector('[role=tab][aria-selected=true]:has-text("Safety")');
  await tab_to(page, '.estop');
  await page.keyboard.press('Enter');
  await until('the robot damps or is off', () => page.evaluate(() => globalThis.kadans.value('safety.level') >= 3));
  await page.waitForSelector('.rung.on:text-matches("damp|off")');
  check(true, 'by keyboard alone a behavior is played and stopped, and the robot too');
  const disable = page.locator('[aria-label^="Disable "]').first();
  const joint = (await disable.getAttribute('aria-label')).slice('Disable '.length);
  await disable.click();
  await page.click(`[aria-label="Enable ${joint}"]`);
  const refusal = `drive of ${joint}: the emergency stop holds the robot`;
  await until('the run refuses to enable a drive while it is stopped', () => page.evaluate((text) => globalThis.kadans.error.includes(text), refusal));
  check(true, 'a drive is disabled by its button, and enabled by none under the emergency stop');
}

// As the system hands a file over when it is let go above the page.
async function drop(page, file) {
  const hand = await page.context().newCDPSession(page);
  const data = { items: [], files: [file], dragOperationsMask: 1 };
  for (const type of ['dragEnter', 'dragOver', 'drop']) await hand.send('Input.dispatchDragEvent', { type, x: 400, y: 300, data });
  await hand.detach();
}

const shows_record = (page) =>
  page.waitForFunction(() => globalThis.kadans && !globalThis.kadans.live && globalThis.kadans.loading === 0 && globalThis.kadans.end_s > 2.5 && globalThis.kadans_drawn?.posed);

export async function check_files(page, record) {
  const view = start(['view', record], /(http:\S+)/);
  const [, url] = await view.begun;
  const empty = new URL('/?empty', url).href;
  await page.goto(empty);
  await page.waitForSelector('text=Drop a record here');
  const visibility = () => page.evaluate(() => document.querySelector('#robot') && getComputedStyle(document.querySelector('#robot')).visibility);
  check((await visibility()) !== 'visible', 'no picture hides what an empty page says');
  await drop(page, record);
  await shows_record(page);
  check(true, 'a file that is dropped on the page is shown');
  await page.goto(empty);
  await page.fill('[aria-label="Address of a record"]', new URL('/record.mcap', url).href);
  await page.keyboard.press('Enter');
  await shows_record(page);
  check(true, 'and one whose address is typed');
  await view.stop();
}

// A frame of the screen may come between a render and its effects. Each act is followed by one in which everything is
// drawn anew, before the browser gets to paint: with data, for nothing is drawn where nothing changed.
const acts = {
  'a signal is added': 'document.querySelector("[data-signal]").dispatchEvent(new KeyboardEvent("keydown", { key: "Enter", bubbles: true }))',
  'a signal is removed': 'document.querySelector(".plot .series + .series button").click()',
  'a plot is closed': 'document.querySelector(".plot .close").click()',
  'another tab': 'document.querySelector("[role=tab][aria-selected=false]").click()',
  'the theme turns': 'document.querySelector(\'[title="Dark or light (t)"]\').click()',
  'a mark goes': 'document.querySelector(".mark").click()',
  'it pauses': 'document.querySelector(".play").click()',
};

// `problems`: of the page so far; plots draw in microtasks, whose errors nobody else catches.
export async function check_between(page, problems) {
  await page.click('.signals .topic:has-text("joint")');
  await page.waitForSelector('[data-signal]');
  for (const [what, act] of Object.entries(acts)) {
    await page.evaluate(async (text) => {
      const { kadans, kadans_frames } = globalThis;
      new Function(text)();
      for (let i = 0; i < 5; ++i) {
        await Promise.resolve(); // renders are microtasks
        ++kadans.version;
        kadans_frames.step(0.001);
      }
    }, act);
    check(problems.length === 0, `a frame may come right after a render: ${what} ${problems}`);
  }
  await page.click('.play');
  await page.click('.signals .topic:has-text("joint")');
  await page.keyboard.press('Escape');
  await page.keyboard.press('1');
}

// Two tabs share what the browser keeps; a page is reloaded and closed while it loads, connects and draws. Chromium forgets
// a close that comes with the first bytes of a navigation, whatever the page is, so none comes before its document stands.
// With KADANS_SOAK each moment comes with and without a reload.
export async function check_tabs(context, url, watch) {
  const page = await context.newPage();
  watch(page);
  await page.goto(url);
  await page.waitForSelector('.plot');
  await page.click('.signals .topic:has-text("joint")');
  for (let step = 0; step < (process.env.KADANS_SOAK ? 12 : 4); ++step) {
    const other = await context.newPage();
    watch(other);
    await other.goto(url, { waitUntil: 'commit' });
    const shown = ['html', '.page', '.plot', '.chart .state'][step % 4];
    await other.waitForSelector(shown, { state: 'attached' });
    await page.evaluate((removes) => {
      if (removes) [...document.querySelectorAll('.plot .series button')].at(-1).click();
      else document.querySelector('[data-signal]').dispatchEvent(new KeyboardEvent('keydown', { key: 'Enter', bubbles: true }));
    }, step % 2 === 0);
    if (step % 3 === 0) await other.reload({ waitUntil: 'domcontentloaded' });
    await within('a page is closed', other.close());
  }
  for (const rubbish of ['{', '7', '[[7]]', '[null]']) {
    await page.evaluate((text) => localStorage.setItem('kadans.plots.tulip', text), rubbish);
    await page.reload();
    await page.waitForSelector('.plot');
  }
  await within('a page is closed', page.close());
  check(true, 'two tabs, reloads and ends at any moment');
}
