// A session from a run that goes on: the Foxglove WebSocket protocol, as far as this page speaks it. Connects again when
// the server was away.
import { is_robot_topic, Session } from './session.js';
import { is_single, read_numbers } from './numbers.js';

const text_of = new TextDecoder();
const bytes_of = new TextEncoder();
const wanted_texts = new Set(['/log', '/transitions', '/active', '/faults', '/timing', '/drives', '/description']);
const again_ms = 500;

class Remote {
  // `run`: {connect(), first}: what makes a socket to the run, and one that may have heard something already.
  constructor(session, { connect, first }) {
    Object.assign(this, { session, open: connect });
    this.writes = false;
    this.verbs = new Set();
    this.plays = []; // names of behaviors that there are
    this.state = {};
    this.calls = new Map();
    this.last_call = 0;
    this.connect(first);
  }

  connect(socket) {
    this.socket = socket;
    this.subscriptions = new Map(); // number -> {topic, width, single}
    socket.onmessage = ({ data }) => this.take(data);
    socket.onclose = () => this.lose();
    for (const data of socket.early.splice(0)) this.take(data);
    if (socket.readyState >= WebSocket.CLOSING) this.lose();
  }

  lose() {
    if (this.closed) return;
    this.socket.onclose = null;
    for (const call of [...this.calls.keys()]) this.end_call(call, { done: false, text: 'the connection was lost before the answer came' });
    this.session.status = 'connecting…';
    this.writes = false;
    this.session.changed();
    setTimeout(() => this.closed || this.connect(this.open()), again_ms);
  }

  take(data) {
    if (typeof data === 'string') this.take_text(JSON.parse(data));
    else this.take_bytes(new DataView(data));
  }

  close() {
    this.closed = true;
    this.socket.close();
  }

  send(json) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(json));
  }

  take_text(json) {
    if (json.op === 'serverInfo') this.take_server(json);
    else if (json.op === 'advertise') this.subscribe(json.channels);
    else if (json.op === 'parameterValues') {
      for (const p of json.parameters) this.session.parameters.set(p.name, p.value);
    } else if (json.op === 'serviceCallFailure') this.end_call(json.callId, { done: false, text: json.message });
    else if (json.op === 'status' && json.id === 'kadans.state') this.state = JSON.parse(json.message);
    else if (json.op === 'status') this.say(json.message);
    this.session.changed();
  }

  say(text) {
    this.session.error = text;
    clearTimeout(this.said);
    this.said = setTimeout(() => ((this.session.error = ''), this.session.changed()), 8000);
  }

  take_server({ metadata, sessionId }) {
    const { session } = this;
    if (session.id !== undefined && session.id !== sessionId) {
      session.topics.clear();
      session.signals.clear();
      session.others.clear();
      session.begin_anew(0); // another run
    }
    session.id = sessionId;
    session.title = metadata.mode ?? 'live';
    session.status = '';
    this.metadata = metadata;
    this.writes = metadata.writes === 'yes';
    this.verbs = new Set((metadata.verbs ?? '').split(' '));
    this.plays = (metadata.plays ?? '').split(' ').filter(Boolean);
    this.send({ op: 'getParameters', parameterNames: [], id: 'all' });
    this.send({ op: 'subscribeParameterUpdates', parameterNames: [] });
  }

  subscribe(channels) {
    const subscriptions = [];
    for (const channel of channels) {
      const signals = this.metadata[`signals${channel.topic}`];
      if (signals === undefined && !wanted_texts.has(channel.topic) && !is_robot_topic(channel.topic)) continue;
      if (signals !== undefined) this.session.add_topic(channel.topic, signals);
      const width = this.session.topics.get(channel.topic)?.width ?? 0;
      this.subscriptions.set(channel.id, { topic: channel.topic, width, single: is_single(channel.schema), numbers: signals !== undefined });
      subscriptions.push({ id: channel.id, channelId: channel.id });
    }
    this.session.active = new Map();
    this.session.transitions.length = this.session.log.length = this.session.faults.length = 0; // the server tells them again
    this.send({ op: 'subscribe', subscriptions });
  }

  take_bytes(view) {
    const kind = view.getUint8(0);
    if (kind === 3) {
      const encoding = view.getUint32(9, true);
      return this.end_call(view.getUint32(5, true), JSON.parse(text_of.decode(new Uint8Array(view.buffer, 13 + encoding))));
    }
    if (kind !== 1) return undefined;
    const subscription = this.subscriptions.get(view.getUint32(1, true));
    if (subscription === undefined) return undefined;
    const t = Number(view.getBigUint64(5, true)) * 1e-9;
    const bytes = new Uint8Array(view.buffer, 13);
    if (!subscription.numbers) return this.session.add_text(subscription.topic, t, bytes);
    const values = new Float32Array(subscription.width);
    read_numbers(bytes, subscription.single, values, 0);
    return this.session.add_rows(subscription.topic, [t], values);
  }

  set_parameter(name, value) {
    this.send({ op: 'setParameters', parameters: [{ name, value }] });
  }

  // The answer: {done, text}; of `why` also its reasons.
  command(verb, { text = '', value = 0, quiet = false } = {}) {
    if (this.socket.readyState !== WebSocket.OPEN) {
      const answer = { done: false, text: `${verb}: the run does not answer` };
      return this.end_call(0, answer), Promise.resolve(answer);
    }
    const call = ++this.last_call;
    const request = bytes_of.encode(JSON.stringify({ verb, text, value }));
    const frame = new Uint8Array(17 + request.length);
    const view = new DataView(frame.buffer);
    view.setUint8(0, 2);
    view.setUint32(1, 1, true);
    view.setUint32(5, call, true);
    view.setUint32(9, 4, true);
    frame.set(bytes_of.encode('json'), 13);
    frame.set(request, 17);
    this.socket.send(frame);
    return new Promise((resolve) => this.calls.set(call, Object.assign(resolve, { quiet })));
  }

  end_call(call, answer) {
    if (!answer.done && !this.calls.get(call)?.quiet) this.say(answer.text);
    this.calls.get(call)?.(answer);
    this.calls.delete(call);
  }
}

export function open_live(run) {
  const session = new Session('live', true);
  session.status = 'connecting…';
  session.remote = new Remote(session, run);
  return session;
}
