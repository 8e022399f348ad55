// A match's record in the page: the robots, by their names, and the ball are where its report says that they were.
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { dirname } from 'node:path';
import { chromium } from 'playwright-core';
import { check, chromium_options, folder, kadans, project, run, start, until } from './program.mjs';

const match = 'drill_supporter', seed = 3;
const apart_m = 0.03; // the record's rows and the report's are some hundredths of a second apart

// Rows of numbers by the names of the columns.
function table(file) {
  const [names, ...rows] = readFileSync(file, 'utf8').trim().split('\n').map((line) => line.split(','));
  return rows.map((row) => Object.fromEntries(names.map((name, i) => [name, Number(row[i])])));
}

// As the world from above draws it: each robot with the name beside it, and the balls.
const drawn = (page) =>
  page.evaluate(() => {
    const numbers = (text) => text.match(/-?[\d.]+(e-?\d+)?/g).map(Number);
    const robots = [...document.querySelectorAll('.world-map .robot-at')].map((robot) => {
      const [x, y, degrees] = numbers(robot.querySelector(':scope > path').getAttribute('transform'));
      return { name: robot.querySelector('.who').textContent, x, y, degrees };
    });
    const balls = [...document.querySelectorAll('.world-map .ball')].map((ball) => ({ x: Number(ball.getAttribute('cx')), y: Number(ball.getAttribute('cy')) }));
    return { robots, balls };
  });

run(async () => {
  const file = `config/matches/${match}.json`;
  const args = ['match', file, '--seed', String(seed), '--report', folder, '--record', `${folder}/match.mcap`];
  try {
    execFileSync(`${dirname(kadans)}/kadans-football`, args, { cwd: project, stdio: 'pipe' });
  } catch (error) {
    check(error.status === 1, `the match is played to its end ${error.stderr}`); // 1: lost
  }
  const rows = table(`${folder}/${match}-${seed}.csv`);
  const { robots } = JSON.parse(readFileSync(`${folder}/${match}-${seed}.json`, 'utf8'));
  check(robots.length === 3, 'three robots play');

  const view = start(['view', `${folder}/match.mcap`], /(http:\S+)/);
  const browser = await chromium.launch(chromium_options);
  const page = await browser.newPage({ viewport: { width: 900, height: 600 } });
  page.setDefaultTimeout(0); // a busy machine draws slowly; run() bounds all of it
  const problems = [];
  page.on('pageerror', (error) => problems.push(error.stack));
  await page.goto((await view.begun)[1]);
  await page.waitForFunction(() => globalThis.kadans?.loading === 0);
  await page.click('[role=tab]:has-text("World")');
  for (const share of [0.2, 0.5, 0.9]) {
    const row = rows[Math.floor(share * rows.length)];
    await page.evaluate((at) => globalThis.kadans.seek(at), row.time_s);
    const near = (at, name) => Math.hypot(at.x - row[`${name}.x_m`], at.y - row[`${name}.y_m`]) < apart_m;
    await until(`at ${row.time_s} s the world from above has the robots where the report has them`, async () => {
      const { robots: shown, balls } = await drawn(page);
      return shown.length === 3 && balls.length === 1 && shown.every((at) => near(at, at.name)) &&
        Math.hypot(balls[0].x - row.ball_x_m, balls[0].y - row.ball_y_m) < 3 * apart_m;
    });
    const { robots: shown } = await drawn(page);
    check(shown.every((at) => Math.abs(Math.sin((at.degrees * Math.PI) / 180 - row[`${at.name}.theta_rad`])) < 0.1), `at ${row.time_s} s they are where the report has them, and turned so`);
  }
  check(new Set((await drawn(page)).robots.map(({ name }) => name)).size === 3, 'each has its own name');
  check(problems.length === 0, `the page has no error ${problems.join('\n')}`);
  await view.stop();
});
