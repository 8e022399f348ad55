// check.mjs FILE: reads the record that mcap_sample wrote with readers that are not ours, every CRC checked: seeking by
// the summary, streaming from the front, and streaming after the file was cut short.
import assert from "node:assert/strict";
import { open, readFile } from "node:fs/promises";

import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { FileHandleReadable } from "@mcap/nodejs";
import { decompress } from "fzstd";

const ticks = 5000;
const joints = ["l_hip", "l_knee", "r_hip", "r_knee"];
const expectedCounts = {
  "/joint": ticks, "/base": ticks / 10, "/tick_overruns": ticks,
  "/log": 10, "/transitions": 5, "/robot_description": 1, "/faults": 10,
  "/joint_states": ticks / 20, "/tf": ticks / 20, "/wrench/l_foot": ticks / 20,
};
const ofViewers = ["/robot_description", "/joint_states", "/wrench/l_foot"];
const decompressHandlers = { zstd: (data, size) => decompress(data, new Uint8Array(Number(size))) };

// What signal `index` holds at a tick, as mcap_sample has it.
const value = (index, tick) => 1000 * index + tick;

function expectedMessage(topic, tick) {
  if (topic === "/joint") {
    return Object.fromEntries(joints.map((joint, i) => [joint, {
      position_rad: value(3 * i, tick),
      motor: { effort_nm: value(3 * i + 1, tick) },
      velocity_rad_s: value(3 * i + 2, tick),
    }]));
  }
  if (topic === "/base") return { tilt_rad: value(12, tick), n2nd_imu: { x: value(13, tick) } };
  if (topic === "/tick_overruns") return { value: value(14, tick) };
  if (topic === "/robot_description") return { data: '<robot name="sample"/>' };
  const timestamp = { sec: Math.floor(tick / 1000), nsec: (tick % 1000) * 1e6 };
  const stamp = { sec: timestamp.sec, nanosec: timestamp.nsec };
  if (topic === "/joint_states") {
    const column = (first) => joints.map((_, i) => value(3 * i + first, tick));
    return { header: { stamp, frame_id: "" }, name: joints, position: column(0), velocity: column(2), effort: [0, 0, 0, 0] };
  }
  if (topic === "/wrench/l_foot") {
    const [force, x] = [value(15, tick), value(16, tick)];
    return {
      header: { stamp, frame_id: "l_foot" },
      wrench: { force: { x: 0, y: 0, z: force }, torque: { x: 0, y: -x * force, z: 0 } },
    };
  }
  if (topic === "/tf") {
    const rotation = { x: 0, y: 0, z: 0, w: 1 };
    const translation = { x: 0, y: 0, z: 0 };
    return { transforms: [{ timestamp, parent_frame_id: "world", child_frame_id: "torso", translation, rotation }] };
  }
  if (topic === "/faults") return { timestamp, name: "velocity_limit", joint: "l_knee", value: 9, limit: 8 };
  if (topic === "/transitions") return { timestamp, behavior: "sample", from: "up", to: "down", why: "second" };
  return { timestamp, level: 3, message: "half a second", name: "sample", file: "", line: 0 };
}

// Decodes by the schema in the file and compares with what was recorded.
class Checker {
  counts = {};
  #decoders = new Map();

  check(message, channel, schema) {
    const tick = Number(message.logTime / 1_000_000n);
    assert.equal(message.publishTime, message.logTime);
    if (channel.messageEncoding === "cdr" && !ofViewers.includes(channel.topic)) assert.equal(message.sequence, tick);
    assert.deepEqual(this.#decode(message.data, channel, schema), expectedMessage(channel.topic, tick));
    this.counts[channel.topic] = (this.counts[channel.topic] ?? 0) + 1;
  }

  #decode(data, channel, schema) {
    const text = new TextDecoder();
    if (channel.messageEncoding === "json") {
      assert.equal(schema.encoding, "jsonschema");
      assert.equal(JSON.parse(text.decode(schema.data)).title, schema.name);
      return JSON.parse(text.decode(data));
    }
    assert.equal(schema.encoding, "ros2msg");
    if (!this.#decoders.has(channel.id)) {
      this.#decoders.set(channel.id, new MessageReader(parse(text.decode(schema.data), { ros2: true })));
    }
    const plain = (_, field) => (ArrayBuffer.isView(field) ? Array.from(field) : field);
    return JSON.parse(JSON.stringify(this.#decoders.get(channel.id).readMessage(data), plain));
  }
}

async function readIndexed(file) {
  const handle = await open(file);
  const reader = await McapIndexedReader.Initialize({ readable: new FileHandleReadable(handle), decompressHandlers });
  const checker = new Checker();
  let last = 0n;
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    assert(message.logTime >= last);
    last = message.logTime;
    const channel = reader.channelsById.get(message.channelId);
    checker.check(message, channel, reader.schemasById.get(channel.schemaId));
  }
  assert.deepEqual(checker.counts, expectedCounts);

  let some = 0;
  for await (const message of reader.readMessages({ topics: ["/joint"], startTime: 2_000_000_000n, endTime: 2_099_000_000n })) {
    assert.equal(message.sequence, 2000 + some++);
  }
  assert.equal(some, 100);

  const statistics = reader.statistics;
  assert.equal(Number(statistics.messageCount), Object.values(expectedCounts).reduce((a, b) => a + b));
  assert.equal(statistics.chunkCount, reader.chunkIndexes.length);
  assert.equal(statistics.messageEndTime, BigInt(ticks - 1) * 1_000_000n);
  for (const [id, count] of statistics.channelMessageCounts) {
    assert.equal(Number(count), expectedCounts[reader.channelsById.get(id).topic] ?? 0);
  }
  assert.equal(reader.chunkIndexes.length, 10);
  const joint = [...reader.channelsById.values()].find((channel) => channel.topic === "/joint");
  assert(joint.metadata.get("signals").startsWith("joint.l_hip.position_rad\trad\tPosition of the joint.\n"));

  const attachments = [];
  for await (const attachment of reader.readAttachments({ validateCrcs: true })) attachments.push(attachment.name);
  assert.deepEqual(attachments, ["sample.urdf"]);
  const metadata = new Map();
  for await (const record of reader.readMetadata()) metadata.set(record.name, record.metadata);
  assert.equal(metadata.get("run").get("scenario"), "sample");
  assert.equal(metadata.get("recorder").get("dropped_rows"), "0");

  await checkDataCrc(file, reader);
  const chunks = reader.chunkIndexes.map((chunk) => ({ ...chunk }));
  await handle.close();
  return chunks;
}

// The summary's offsets lead to what they say, and DataEnd's CRC is that of everything before it.
async function checkDataCrc(file, reader) {
  const bytes = await readFile(file);
  const { crc32 } = await import("@foxglove/crc");
  const end = Number(reader.dataEndOffset);
  assert.equal(bytes[end], 0x0f);
  assert.equal(bytes.readUInt32LE(end + 9), crc32(bytes.subarray(0, end)));
  assert.notEqual(reader.footer.summaryCrc, 0);
  for (const [opcode, offset] of reader.summaryOffsetsByOpcode) {
    assert.equal(bytes[Number(offset.groupStart)], opcode);
  }
}

function stream(bytes) {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  const checker = new Checker();
  const channels = new Map();
  const schemas = new Map();
  for (let at = 0; at < bytes.length; at += 65536) {
    reader.append(bytes.subarray(at, at + 65536));
    for (let record; (record = reader.nextRecord()); ) {
      if (record.type === "Schema") schemas.set(record.id, record);
      if (record.type === "Channel") channels.set(record.id, record);
      if (record.type !== "Message") continue;
      const channel = channels.get(record.channelId);
      checker.check(record, channel, schemas.get(channel.schemaId));
    }
  }
  return { counts: checker.counts, done: reader.done() };
}

function checkCut(bytes, chunks, cut) {
  const { counts, done } = stream(bytes.subarray(0, cut));
  assert(!done);
  const whole = chunks.filter((chunk) => Number(chunk.chunkStartOffset + chunk.chunkLength) <= cut);
  // The sample's chunks hold 500 ticks each.
  assert.equal(counts["/joint"] ?? 0, 500 * whole.length, `cut at ${cut}`);
}

const file = process.argv[2];
const chunks = await readIndexed(file);
const bytes = await readFile(file);
const { counts, done } = stream(bytes);
assert(done);
assert.deepEqual(counts, expectedCounts);
let seed = 12345;
for (let i = 0; i < 20; ++i) {
  seed = (seed * 48271) % 2147483647;
  checkCut(bytes, chunks, 100 + (seed % (Number(chunks.at(-1).chunkStartOffset) - 100)));
}
console.log(`${file}: ${bytes.length} bytes, read indexed, streamed and cut short at 20 places`);
