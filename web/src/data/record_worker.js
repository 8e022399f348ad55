// Reads a record beside the page's own thread: a File, or an address. Streams, so that a record cut short shows up to
// its last whole chunk. Posts {kind, ...}: topic, rows, text, progress, done, failed.
import { McapStreamReader } from '@mcap/core';
import { decompress } from 'fzstd';
import { is_single, read_numbers } from './numbers.js';

const batch_rows = 2000;
const batches = new Map(); // channel id -> {topic, width, single, times, values, count}

function send(batch) {
  if (batch.count === 0) return;
  const times = batch.times.slice(0, batch.count);
  const values = batch.values.slice(0, batch.count * batch.width);
  postMessage({ kind: 'rows', topic: batch.topic, times, values }, [times.buffer, values.buffer]);
  batch.count = 0;
}

const send_all = () => batches.forEach(send);

class Reading {
  constructor() {
    this.reader = new McapStreamReader({
      decompressHandlers: { zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size))) },
    });
    this.schemas = new Map();
    this.texts = new Map(); // channel id -> topic
  }

  take(bytes) {
    this.reader.append(bytes);
    for (let record; (record = this.reader.nextRecord()); ) this.take_record(record);
  }

  take_record(record) {
    if (record.type === 'Schema') this.schemas.set(record.id, new TextDecoder().decode(record.data));
    else if (record.type === 'Channel') this.take_channel(record);
    else if (record.type === 'Message') this.take_message(record);
    else if (record.type === 'Metadata') postMessage({ kind: 'facts', name: record.name, facts: [...record.metadata] });
  }

  take_channel(channel) {
    if (batches.has(channel.id) || this.texts.has(channel.id)) return;
    const signals = channel.metadata.get('signals');
    if (signals === undefined) return this.texts.set(channel.id, channel.topic);
    const width = signals.split('\n').filter((line) => line).length;
    const single = is_single(this.schemas.get(channel.schemaId) ?? '');
    const [times, values] = [new Float64Array(batch_rows), new Float32Array(batch_rows * width)];
    batches.set(channel.id, { topic: channel.topic, width, single, times, values, count: 0 });
    postMessage({ kind: 'topic', topic: channel.topic, signals });
  }

  take_message(message) {
    const t = Number(message.logTime) * 1e-9;
    const batch = batches.get(message.channelId);
    if (batch === undefined) {
      const topic = this.texts.get(message.channelId);
      return postMessage({ kind: 'text', topic, t, bytes: message.data.slice() });
    }
    read_numbers(message.data, batch.single, batch.values, batch.count * batch.width);
    batch.times[batch.count++] = t;
    if (batch.count === batch_rows) send(batch);
  }
}

const unread = (why) => {
  throw Object.assign(new Error(why), { unread: true });
};

async function open(source) {
  let stream;
  let size = 0;
  if (typeof source === 'string') {
    const answer = await fetch(source).catch(() => unread(`nothing answers at ${source}, or it does not let this page read it`));
    if (!answer.ok) unread(`${source} answers ${answer.status} ${answer.statusText}`);
    size = Number(answer.headers.get('content-length'));
    stream = answer.body;
  } else {
    size = source.size;
    stream = source.stream();
  }
  return { stream: stream.getReader(), size };
}

onmessage = async ({ data: source }) => {
  try {
    const { stream, size } = await open(source);
    const reading = new Reading();
    let got = 0;
    for (;;) {
      const { done, value } = await stream.read();
      if (done) break;
      got += value.byteLength;
      reading.take(value);
      send_all();
      postMessage({ kind: 'progress', share: size > 0 ? Math.min(1, got / size) : 0.5 });
    }
    send_all();
    postMessage({ kind: 'done', complete: reading.reader.done(), empty: batches.size === 0 });
  } catch (error) {
    send_all();
    postMessage({ kind: 'failed', unread: Boolean(error.unread), why: String(error.message ?? error) });
  }
};
