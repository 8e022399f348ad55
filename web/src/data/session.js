// All that is known of one run, live or from a record, and the place in time that is looked at. Sources fill it, panels
// read it; `version` grows with whatever is not a mere new row, so that panels know when to look again.
import { Topic } from './topic.js';

const events_max = 5000;
const json_topics = new Set(['/description', '/transitions', '/active', '/log', '/faults', '/timing', '/drives', '/parameters']);
const text_of = new TextDecoder();

const robot_topic = '/robot_description'; // of a further robot: /NAME/robot_description
export const is_robot_topic = (topic) => topic.endsWith(robot_topic);

const seconds = (stamp) => stamp.sec + stamp.nsec * 1e-9;

function keep(list, entry) {
  // Events of several writers come nearly in order.
  let at = list.length;
  while (at > 0 && list[at - 1].t > entry.t) --at;
  list.splice(at, 0, entry);
  if (list.length > events_max) list.splice(0, list.length - events_max);
}

export class Session {
  constructor(title, live) {
    this.title = title;
    this.live = live;
    this.topics = new Map();
    this.signals = new Map(); // name -> {topic, column, unit, doc}
    this.transitions = [];
    this.active = new Map(); // behavior -> [{t, states}]: the innermost active states from that time on
    this.log = [];
    this.faults = [];
    this.timing = null;
    this.drives = null; // of a live run: what they said last
    this.description = null;
    this.urdf = null;
    this.others = new Map(); // further robots of the world: name, which begins their signals -> URDF
    this.parameters = new Map(); // name -> value now
    this.start_s = 0;
    this.end_s = 0;
    this.cursor_s = 0;
    this.playing = live;
    this.following = live; // the cursor stays at the newest
    this.speed = 1;
    this.loading = 0; // 0..1 while a record is read
    this.status = '';
    this.error = '';
    this.remote = null; // of a live run: what can be asked of it
    this.version = 0;
    this.listeners = new Set();
  }

  changed() {
    ++this.version;
    for (const listener of this.listeners) listener();
  }

  listen(listener) {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  // `description`: a line a signal: name, unit, sentence, separated by tabs.
  add_topic(name, description) {
    if (this.topics.has(name)) return;
    const signals = description
      .split('\n')
      .filter((line) => line)
      .map((line) => {
        const [signal, unit, doc] = line.split('\t');
        return { name: signal, unit: unit ?? '', doc: doc ?? '' };
      });
    const limits = this.live ? { rows_max: 16_000, keep_newest: true } : {};
    const topic = new Topic(name, signals, limits);
    this.topics.set(name, topic);
    signals.forEach((signal, column) => this.signals.set(signal.name, { ...signal, topic, column }));
    this.changed();
  }

  add_rows(name, times, values) {
    const topic = this.topics.get(name);
    if (!topic || times.length === 0) return;
    const newest = times[times.length - 1];
    if (this.live && newest < this.end_s - 1) this.begin_anew(times[0]);
    if (topic.count === 0 && (this.end_s === this.start_s || times[0] < this.start_s)) this.start_s = times[0];
    topic.append(times, values);
    if (newest > this.end_s) this.end_s = newest;
    if (this.live && topic.times[0] > this.start_s) this.start_s = topic.times[0];
  }

  begin_anew(t) {
    for (const topic of this.topics.values()) topic.count = 0;
    this.transitions = [];
    this.active = new Map();
    this.log = [];
    this.faults = [];
    this.start_s = this.end_s = this.cursor_s = t;
    this.changed();
  }

  add_text(topic, t, bytes) {
    if (is_robot_topic(topic)) {
      const length = new DataView(bytes.buffer, bytes.byteOffset).getUint32(4, true);
      const urdf = text_of.decode(bytes.subarray(8, 8 + length - 1));
      const other = topic.slice(1, -robot_topic.length);
      if (other) this.others.set(other, urdf);
      else this.urdf = urdf;
      return this.changed();
    }
    if (!json_topics.has(topic)) return; // for other viewers
    const json = JSON.parse(text_of.decode(bytes));
    if (topic === '/description') {
      this.description = json;
      for (const p of json.parameters) if (!this.parameters.has(p.name)) this.parameters.set(p.name, p.value);
    } else if (topic === '/transitions') {
      keep(this.transitions, { t: seconds(json.timestamp), ...json });
    } else if (topic === '/active') {
      if (!this.active.has(json.behavior)) this.active.set(json.behavior, []);
      keep(this.active.get(json.behavior), { t: seconds(json.timestamp), states: json.states });
    } else if (topic === '/log') {
      keep(this.log, { t: seconds(json.timestamp), ...json });
    } else if (topic === '/faults') {
      keep(this.faults, { t: seconds(json.timestamp), ...json });
    } else if (topic === '/timing') {
      this.timing = json;
    } else if (topic === '/drives') {
      this.drives = json;
    } else if (topic === '/parameters') {
      for (const { name, value } of json.parameters) this.parameters.set(name, value);
    }
    this.changed();
  }

  value(name, t = this.cursor_s) {
    const signal = this.signals.get(name);
    return signal ? signal.topic.value_at(t, signal.column) : NaN;
  }

  seek(t) {
    this.following = this.live && t >= this.end_s - 0.02;
    this.cursor_s = Math.min(Math.max(t, this.start_s), this.end_s);
  }

  // Each frame of the screen.
  advance(dt_s) {
    if (this.following) {
      if (this.playing) this.cursor_s = this.end_s;
      return;
    }
    if (!this.playing) return;
    this.cursor_s = Math.min(this.end_s, this.cursor_s + dt_s * this.speed);
    if (!this.live && this.loading === 0 && this.cursor_s >= this.end_s) this.playing = false;
  }

  toggle_play() {
    this.playing = !this.playing;
    if (this.playing && this.live) this.following = true;
    if (this.playing && !this.live && this.cursor_s >= this.end_s) this.cursor_s = this.start_s;
  }

  // The newest transition of each behavior up to t.
  last_transitions(t = this.cursor_s) {
    const newest = new Map();
    for (const entry of this.transitions) {
      if (entry.t > t) break;
      newest.set(entry.behavior, entry);
    }
    return newest;
  }
}
