// The program under test: started, awaited, stopped; and conditions that are awaited, not slept for.
import { spawn } from 'node:child_process';

export const [kadans, project, folder] = process.argv.slice(2);
const patience_ms = 40_000;
const all_ms = Number(process.env.KADANS_ALL_MS ?? 600_000);
const running = new Set();
let last_ok = 'nothing';

export function check(truth, what) {
  if (!truth) throw new Error(`not so: ${what}`);
  console.log(`ok    ${what}`);
  last_ok = what;
}

// Rejects when there is no answer: a browser that hangs is a failure with a name.
export async function within(what, answer) {
  let timer;
  const late = new Promise((_, reject) => {
    timer = setTimeout(() => reject(new Error(`no answer: ${what}`)), patience_ms);
  });
  try {
    return await Promise.race([answer, late]);
  } finally {
    clearTimeout(timer);
  }
}

// Resolves with the first line on stderr or stdout that fits, as its match.
export function start(args, line) {
  const child = spawn(kadans, args, { cwd: folder, stdio: ['ignore', 'pipe', 'pipe'] });
  running.add(child);
  child.once('exit', () => running.delete(child));
  let said = '';
  const begun = new Promise((resolve, reject) => {
    const hear = (bytes) => {
      said += bytes;
      const found = said.match(line);
      if (found) resolve(found);
    };
    child.stdout.on('data', hear);
    child.stderr.on('data', hear);
    child.once('exit', (code) => reject(new Error(`kadans ${args.join(' ')} ended with ${code}: ${said}`)));
    setTimeout(() => reject(new Error(`kadans ${args.join(' ')} did not begin: ${said}`)), patience_ms).unref();
  });
  const stop = () =>
    within(`kadans ${args[0]} ends by SIGINT: ${said}`, new Promise((resolve) => {
      if (child.exitCode !== null || child.signalCode !== null) return resolve();
      child.once('exit', resolve);
      child.kill('SIGINT');
    }));
  return { child, begun, stop };
}

// Draws WebGL in software, keeps to itself.
export const chromium_options = {
  executablePath: process.env.KADANS_CHROMIUM ?? 'chromium',
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-background-networking', '--disable-component-update', '--disable-sync', '--no-first-run', '--disable-dev-shm-usage'],
};

export const scenario = (name) => `${project}/config/scenarios/${name}.json`;
export const live_address = /live on (http:\/\/127\.0\.0\.1:(\d+)\/\?token=(\w+))/;

// Asks again until it is so.
export async function until(what, ask) {
  const end = Date.now() + patience_ms;
  for (;;) {
    const answer = await within(what, ask());
    if (answer) return answer;
    if (Date.now() > end) throw new Error(`never so: ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
}

export async function run(checks) {
  const end = (error) => {
    if (error) console.error(error);
    for (const child of running) child.kill('SIGKILL');
    process.exit(error ? 1 : 0);
  };
  setTimeout(() => end(new Error(`not done in ${all_ms / 1000} s, the last that was so: ${last_ok}`)), all_ms);
  await checks().then(() => end(), end); // a browser ends with this process
}
