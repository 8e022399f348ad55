// A behavior that waits for events: the form that sends them, and the forms of transitions that its chart draws.
import { cpSync, mkdirSync, rmSync, writeFileSync } from 'node:fs';
import { check, folder, live_address, project, start, until } from './program.mjs';

const behavior = `local k = require "kadans"
k.events {
  ball_seen = { "a ball is seen", distance_m = { "m", min = 0, max = 5 }, left = k.flag, who = { k.text, optional = true } },
  whistle = { "both regions go on" },
  back = {},
}
return k.behavior "forms" {
  initial = "work",
  k.parallel "work" {
    { on = "ball_seen", action = function(_, s)
      print(string.format("ball at %.2f m, left %s, %s", s.event.data.distance_m, s.event.data.left, s.event.data.who))
    end },
    { on = "whistle", to = { "work.legs.walk", "work.arms.swing" } },
    k.region "legs" {
      initial = "stand",
      { on = "back", to = "stand", internal = true },
      k.state "stand" { endless = true },
      k.state "walk" { endless = true },
    },
    k.region "arms" { initial = "hang", k.state "hang" { endless = true }, k.state "swing" { endless = true } },
  },
}
`;

// A project of its own, on virtual time.
function forms_project() {
  const root = `${folder}/forms`;
  rmSync(root, { recursive: true, force: true });
  mkdirSync(`${root}/config/scenarios`, { recursive: true });
  for (const part of ['config/jiwiy', 'models/jiwiy', 'behaviors/jiwiy']) cpSync(`${project}/${part}`, `${root}/${part}`, { recursive: true });
  writeFileSync(`${root}/behaviors/jiwiy/forms.lua`, behavior);
  const scenario = `${root}/config/scenarios/forms.json`;
  writeFileSync(scenario, JSON.stringify({ name: 'forms', robot: 'config/jiwiy/robot.json', plant: 'ideal', behaviors: ['forms'], duration_s: 600 }));
  return scenario;
}

const texts = (page, selector) => page.evaluate((wanted) => [...document.querySelectorAll(wanted)].map((found) => found.textContent), selector);
const said = (page, words) => page.evaluate((text) => globalThis.kadans.log.some((line) => line.message.includes(text)), words);
const lit = (page) => page.evaluate(() => [...document.querySelectorAll('.chart .state.active')].map((state) => state.dataset.path).sort().join());

export async function check_forms(page) {
  const sim = start(['sim', forms_project(), '--no-record', '--no-ctl', '--live=0', '--live-token', 'test'], live_address);
  await page.goto((await sim.begun)[1]);
  await page.click('[role=tab]:has-text("Behavior")');
  await page.waitForSelector('.chart .state');
  const actions = await texts(page, '.chart .edge.alone text');
  check(actions.length === 1 && /ball_seen.*\/ action/.test(actions[0]), `an action alone is a line in the box of its state: ${actions}`);
  const labels = await texts(page, '.chart .edge:not(.alone) text');
  check(labels.some((label) => /back.*\{local\}/.test(label)), `an internal transition says so: ${labels}`);
  const bars = await page.evaluate(() => [...document.querySelectorAll('.chart .edge')].filter((edge) => edge.querySelector('.fork')).map((edge) => edge.querySelectorAll('.line').length));
  check(bars.length === 1 && bars[0] === 3, `several targets are one arrow to a bar, and one from it to each: ${bars}`);

  const form = page.locator('form.emit');
  await form.locator('[aria-label="Event"]').selectOption('ball_seen');
  check((await form.locator('label').count()) === 3, 'the form has the fields that the event declares');
  const distance = form.locator('[aria-label="distance_m"]');
  await distance.fill('7');
  await form.locator('button').click();
  check(await distance.evaluate((field) => !field.checkValidity()), 'what is out of range is not sent');
  await distance.fill('1.5');
  await form.locator('[aria-label="who"]').fill('Ann "B"');
  await form.locator('button').click();
  await until('the behavior gets the event with its data', () => said(page, 'ball at 1.50 m, left false, Ann "B"'));
  check(!(await said(page, 'ball at 7')), 'the form sends an event with its data, checked');
  await until('both regions begin', async () => (await lit(page)) === 'work.arms.hang,work.legs.stand');
  await form.locator('[aria-label="Event"]').selectOption('whistle');
  check((await form.locator('label').count()) === 0, 'one without data has no field');
  await form.locator('button').click();
  await until('both regions go on', async () => (await lit(page)) === 'work.arms.swing,work.legs.walk');
  check(true, 'a transition with several targets lights them all');
  await sim.stop();
}
