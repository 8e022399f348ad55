// cut.mjs WHOLE CUT: reads a cut of a record and the record itself with readers that are not ours, every CRC checked: what
// the cut holds is what the record holds at that time, and nothing is missing.
import assert from "node:assert/strict";
import { open } from "node:fs/promises";

import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { McapIndexedReader } from "@mcap/core";
import { FileHandleReadable } from "@mcap/nodejs";
import { decompress } from "fzstd";

const [from, to] = [1_500_000_000n, 3_500_000_000n];
const decompressHandlers = { zstd: (data, size) => decompress(data, new Uint8Array(Number(size))) };
const text = new TextDecoder();

async function read(file) {
  const readable = new FileHandleReadable(await open(file));
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  const decoders = new Map();
  const messages = [];
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const channel = reader.channelsById.get(message.channelId);
    const schema = reader.schemasById.get(channel.schemaId);
    let value = message.data;
    if (channel.messageEncoding === "json") {
      value = JSON.parse(text.decode(message.data));
    } else {
      if (!decoders.has(channel.id)) decoders.set(channel.id, new MessageReader(parse(text.decode(schema.data), { ros2: true })));
      value = JSON.parse(JSON.stringify(decoders.get(channel.id).readMessage(message.data)));
    }
    messages.push({ topic: channel.topic, time: message.logTime, tick: message.sequence, value });
  }
  const attachments = [];
  for await (const attachment of reader.readAttachments({ validateCrcs: true })) attachments.push(attachment.name);
  const metadata = new Map();
  for await (const record of reader.readMetadata()) metadata.set(record.name, record.metadata);
  return { reader, messages, attachments, metadata };
}

const [whole, cut] = await Promise.all(process.argv.slice(2).map(read));
const within = whole.messages.filter(({ time }) => time >= from && time <= to);
const of = (messages, topic) => messages.filter((message) => message.topic === topic);
const knee = of(within, "/joint").map((message) => ({ ...message, value: { l_knee: message.value.l_knee } }));
assert(knee.length > 0);
assert.deepEqual(of(cut.messages, "/joint").filter(({ time }) => time >= from), knee);
for (const topic of ["/base", "/log", "/transitions"])
  assert.deepEqual(of(cut.messages, topic).filter(({ time }) => time >= from), of(within, topic), topic);
assert.equal(of(cut.messages, "/tick_overruns").length, 0);
assert.equal(of(cut.messages, "/robot_description").length, 1);
assert(cut.messages.every(({ time }) => time <= to));
assert.deepEqual(cut.attachments, whole.attachments);
assert.deepEqual(cut.metadata.get("run"), whole.metadata.get("run"));
assert.equal(cut.metadata.get("cut").get("from_s"), "1.5");
assert.equal(Number(cut.reader.statistics.messageCount), cut.messages.length);
assert(cut.reader.chunkIndexes.length > 1);
console.log(`${process.argv[3]}: ${cut.messages.length} messages of ${whole.messages.length}, as they were`);
process.exit();
