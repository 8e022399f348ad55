// The debugger against the public client of the Debug Adapter Protocol: a seeded random walk forwards and backwards. At
// equal moments the hash of all states, that of the lines, the stack and its locals are equal; how long a step back takes
// is printed. KADANS_STEPS: how many steps (default 60, in each scenario).
import { createRequire } from 'node:module';
import { check, kadans, project, run, scenario } from './program.mjs';

const { DebugClient } = createRequire(import.meta.url)('@vscode/debugadapter-testsupport');
const steps = Number(process.env.KADANS_STEPS ?? 60);
const seed = Number(process.env.KADANS_SEED ?? 1);

function drawn(from) {
  let state = from >>> 0;
  return (below) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor((state / 2 ** 32) * below);
  };
}

async function look(client, stopped) {
  const moment = (await client.customRequest('kadans/position')).body;
  const { stackFrames } = (await client.stackTraceRequest({ threadId: stopped.threadId })).body;
  const { scopes } = (await client.scopesRequest({ frameId: stackFrames[0].id })).body;
  const locals = scopes.find((scope) => scope.name === 'locals');
  const shown = locals ? (await client.variablesRequest({ variablesReference: locals.variablesReference })).body.variables : [];
  const text = [moment.state_hash, moment.way_hash]
    .concat(stackFrames.map((frame) => `${frame.name} ${frame.line}`))
    .concat(shown.map(({ name, value }) => `${name}=${value}`));
  return { at: moment.at.join('.'), text: text.join('\n'), time_s: moment.time_s };
}

async function walk(name) {
  const client = new DebugClient(kadans, 'debug', 'kadans', { cwd: project });
  client.defaultTimeout = 60_000;
  await client.start();
  const stop = (ask) => Promise.all([client.waitForEvent('stopped'), ask()]).then(([event]) => event.body);
  await Promise.all([client.waitForEvent('initialized'), client.initializeRequest(), client.launch({ program: scenario(name), stopOnEntry: true, stopAtEnd: true })]);
  await client.setExceptionBreakpointsRequest({ filters: ['transition'] });
  let stopped = await stop(() => client.configurationDoneRequest());
  const draw = drawn(seed), seen = new Map(), back_ms = [];
  let again = 0;
  stopped = await stop(() => client.customRequest('kadans/goto', { tick: 500 + draw(6000) }));
  for (let i = 0; i < steps; ++i) {
    const { threads } = (await client.threadsRequest()).body;
    const threadId = threads.some(({ id }) => id === stopped.threadId) && stopped.threadId !== 1 ? stopped.threadId : threads.at(-1).id;
    const over = stopped.text === 'the run is over'; // going on would end it
    const way = draw(over ? 8 : 20);
    const began = performance.now();
    if (way < 8) {
      stopped = await stop(() => client.stepBackRequest({ threadId }));
      back_ms.push(performance.now() - began);
    } else if (way < 11) stopped = await stop(() => client.stepInRequest({ threadId }));
    else if (way < 14) stopped = await stop(() => client.nextRequest({ threadId }));
    else if (way < 15) stopped = await stop(() => client.stepOutRequest({ threadId }));
    else if (way < 17) stopped = await stop(() => client.customRequest('kadans/ticks', { unit: 'control', count: draw(41) - 20 }));
    else if (way < 18) stopped = await stop(() => client.customRequest('kadans/ticks', { unit: 'behavior', count: draw(41) - 20 }));
    else if (way < 19) stopped = await stop(() => client.reverseContinueRequest({ threadId }));
    else stopped = await stop(() => client.customRequest('kadans/goto', { tick: 500 + draw(6000) }));
    const moment = await look(client, stopped);
    if (!seen.has(moment.at)) {
      seen.set(moment.at, moment.text);
      continue;
    }
    again += 1;
    if (seen.get(moment.at) !== moment.text)
      throw new Error(`${name}, step ${i}, moment ${moment.at} was\n${seen.get(moment.at)}\nand is now\n${moment.text}`);
  }
  back_ms.sort((a, b) => a - b);
  const percentile = (part) => back_ms[Math.min(back_ms.length - 1, Math.floor(part * back_ms.length))].toFixed(1);
  console.log(`      ${name}: ${steps} steps, ${seen.size} moments, ${again} seen again; a step back takes ${percentile(0.5)} ms (p99 ${percentile(0.99)} ms)`);
  check(again > steps / 10, `${name}: every moment that was seen again is the same`);
  await client.stop();
}

await run(async () => {
  for (const name of ['get_up_prone', 'list_of_behaviors']) await walk(name);
});
