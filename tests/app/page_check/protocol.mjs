// The live server against the public client of the Foxglove WebSocket protocol.
import protocol from '@foxglove/ws-protocol';
import { WebSocket } from 'ws';
import { check, live_address, run, scenario, start, until } from './program.mjs';

const { FoxgloveClient } = protocol;

class Viewer {
  constructor(address, subprotocols) {
    this.socket = new WebSocket(address, subprotocols);
    this.client = new FoxgloveClient({ ws: this.socket });
    Object.assign(this, { channels: new Map(), services: [], messages: new Map(), parameters: new Map(), told: [], answers: [], assets: [] });
    this.client.on('serverInfo', (info) => (this.info = info));
    this.client.on('advertise', (channels) => channels.forEach((channel) => this.channels.set(channel.topic, channel)));
    this.client.on('advertiseServices', (services) => this.services.push(...services));
    this.client.on('message', ({ subscriptionId, timestamp, data }) => this.messages.set(subscriptionId, { timestamp, data }));
    this.client.on('parameterValues', ({ parameters }) => parameters.forEach((p) => this.parameters.set(p.name, p.value)));
    this.client.on('status', (status) => this.told.push(status));
    this.client.on('serviceCallResponse', (answer) => this.answers.push(answer));
    this.client.on('serviceCallFailure', (answer) => this.answers.push(answer));
    this.client.on('fetchAssetResponse', (asset) => this.assets.push(asset));
    this.client.on('error', () => {});
  }
  async ready() {
    await until('the server says what there is', () => this.info && this.channels.size > 0 && this.services.length > 0);
    return this;
  }
  subscribe(topic) {
    return this.client.subscribe(this.channels.get(topic).id);
  }
  async order(verb, text = '', value = 0) {
    const before = this.answers.length;
    const data = new TextEncoder().encode(JSON.stringify({ verb, text, value }));
    this.client.sendServiceCallRequest({ serviceId: this.services[0].id, callId: before + 1, encoding: 'json', data: new DataView(data.buffer) });
    await until(`an answer to ${verb}`, () => this.answers.length > before);
    const answer = this.answers[before];
    return answer.data ? JSON.parse(new TextDecoder().decode(answer.data)) : answer;
  }
}

const refused = (address, options) =>
  new Promise((resolve) => {
    const socket = new WebSocket(address, ['foxglove.sdk.v1'], options);
    socket.on('unexpected-response', (_, answer) => resolve(answer.statusCode));
    socket.on('open', () => resolve(0));
    socket.on('error', () => {});
  });

run(async () => {
  const sim = start(['sim', scenario('squat'), '--duration', '600', '--live=0', '--no-record', '--no-ctl'], live_address);
  const [, , port, token] = await sim.begun;
  const plain = `ws://127.0.0.1:${port}/`;

  for (const subprotocol of ['foxglove.sdk.v1', 'foxglove.websocket.v1']) {
    const viewer = await new Viewer(plain, [subprotocol]).ready();
    check(viewer.socket.protocol === subprotocol, `it speaks ${subprotocol}`);
    viewer.client.close();
  }
  const both = await new Viewer(plain, ['foxglove.websocket.v1', 'foxglove.sdk.v1']).ready();
  check(both.socket.protocol === 'foxglove.sdk.v1', 'it prefers foxglove.sdk.v1');
  both.client.close();

  const reader = await new Viewer(plain, ['foxglove.sdk.v1']).ready();
  for (const topic of ['/joint', '/joint_states', '/tf', '/log', '/transitions', '/active', '/faults', '/timing', '/robot_description', '/description'])
    check(reader.channels.has(topic), `there is a channel ${topic}`);
  const joints = reader.subscribe('/joint_states');
  const first = (await until('joint states come', () => reader.messages.get(joints))).timestamp;
  await until('joint states go on', () => reader.messages.get(joints).timestamp > first);
  const described = reader.subscribe('/description');
  const description = JSON.parse(new TextDecoder().decode((await until('the description', () => reader.messages.get(described))).data));
  check(description.behaviors[0].chart.states.length > 3, 'the chart of the behavior is described');
  const transitions = reader.subscribe('/transitions');
  await until('the behavior changes its state', () => reader.messages.get(transitions));

  reader.client.fetchAsset('package://tulip/tulip.urdf', 1);
  reader.client.fetchAsset('file:///etc/passwd', 2);
  await until('both assets are answered', () => reader.assets.length === 2);
  check(new TextDecoder().decode(reader.assets[0].data).includes('<robot name="tulip"'), 'the URDF is an asset');
  check(reader.assets[1].status !== 0, 'another file is none');

  const name = 'posture.l_knee.kp_Nm_per_rad';
  reader.client.getParameters([], 'all');
  await until('all parameters', () => reader.parameters.size > 50);
  const before = reader.parameters.get(name);
  reader.client.setParameters([{ name, value: before + 10 }]);
  await until('who has no token is refused', () => reader.told.some((status) => status.level === 2));
  reader.client.subscribeParameterUpdates([name]);

  const writer = await new Viewer(`${plain}?token=${token}`, ['foxglove.sdk.v1']).ready();
  writer.client.setParameters([{ name, value: before + 10 }], 'mine');
  await until('the writer is told', () => writer.parameters.get(name) === before + 10);
  await until('who watches is told', () => reader.parameters.get(name) === before + 10);
  check(true, 'a parameter is set by who has the token, and told to who watches');
  writer.client.setParameters([{ name, value: 1e12 }]);
  await until('out of range is refused', () => writer.told.some((status) => status.message.includes('outside its range')));
  check((await writer.order('undo')).done, 'a change is taken back');
  await until('who watches is told of that', () => reader.parameters.get(name) === before);
  check((await writer.order('pause')).done && (await writer.order('resume')).done, 'behaviors pause and go on');
  check(/no order/.test((await writer.order('dance')).message ?? ''), 'an order that there is not is refused');
  check((await writer.order('hold')).done, 'time is held');

  check((await refused(plain, { origin: 'http://elsewhere.example' })) === 403, 'a page from elsewhere needs the token');
  check((await refused(`${plain}?token=${token}`, { origin: 'http://elsewhere.example' })) === 0, 'with it, it may connect');
  await sim.stop();
});
