// Reads what `jaywalk export` wrote with the readers that Foxglove uses: as a stream and by its index, every message
// decoded by its own schema and encoded again to the same bytes, speeds held against robot.csv (poses: read_mcap.py).
// usage: node mcap_peer.mjs RUN.mcap ROBOT.csv
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { parse } from "@foxglove/rosmsg";
import { MessageReader, MessageWriter } from "@foxglove/rosmsg2-serialization";
import { decompress } from "fzstd";
import { readFileSync } from "node:fs";
import { crc32 } from "node:zlib";

const [file, table] = process.argv.slice(2);
const bytes = readFileSync(file);
let failures = 0;
const check = (holds, what) => {
  if (!holds && ++failures <= 10) console.log(`FAILED: ${what}`);
};

const decompressHandlers = { zstd: (packed, size) => decompress(packed, new Uint8Array(Number(size))) };
const stream = new McapStreamReader({ validateCrcs: true, decompressHandlers });
stream.append(bytes);
const schemas = new Map(), channels = new Map(), messages = new Map();
for (let record; (record = stream.nextRecord()) != undefined; ) {
  if (record.type === "Schema") schemas.set(record.id, record);
  if (record.type === "Channel" && !channels.has(record.id)) {
    const schema = schemas.get(record.schemaId);
    const definitions = parse(new TextDecoder().decode(schema.data), { ros2: true });
    channels.set(record.id, {
      topic: record.topic,
      type: schema.name,
      reader: new MessageReader(definitions),
      writer: new MessageWriter(definitions),
    });
    messages.set(record.topic, []);
  }
  if (record.type !== "Message") continue;
  const channel = channels.get(record.channelId);
  const message = channel.reader.readMessage(record.data);
  const again = channel.writer.writeMessage(message);
  check(Buffer.compare(Buffer.from(again), Buffer.from(record.data)) === 0, `${channel.topic}: encodes to other bytes`);
  messages.get(channel.topic).push({ time: record.logTime, message });
}
check(stream.done(), "the stream ends before its end");

const readable = {
  size: async () => BigInt(bytes.length),
  read: async (offset, size) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + size))),
};
const indexed = await McapIndexedReader.Initialize({ readable, decompressHandlers });
const counts = new Map();
let last = 0n;
for await (const message of indexed.readMessages()) {
  const topic = indexed.channelsById.get(message.channelId).topic;
  counts.set(topic, (counts.get(topic) ?? 0) + 1);
  check(message.logTime >= last, "not in the order of time by the index");
  last = message.logTime;
}
check(indexed.header.profile === "ros2", "the profile is not ros2");
check(indexed.statistics.messageCount === BigInt([...counts.values()].reduce((a, b) => a + b, 0)), "statistics");
for (const [topic, list] of messages) check(list.length === (counts.get(topic) ?? 0), `${topic}: index and stream differ`);
for (const topic of ["/scan", "/points", "/odom", "/tf", "/map", "/plan", "/goal_pose", "/tracks", "/diagnostics", "/cmd_vel", "/tf_static", "/clock"])
  check((counts.get(topic) ?? 0) > 0, `${topic}: no message`);

const [head, ...rows] = readFileSync(table, "utf8").trim().split("\n").map((line) => line.split(","));
const column = (row, name) => Number(row[head.indexOf(name)]);
const odom = messages.get("/odom"), speeds = messages.get("/cmd_vel");
check(odom.length === rows.length, `/odom has ${odom.length} messages, robot.csv ${rows.length} rows`);
rows.forEach((row, k) => {
  const near = (a, b) => Math.abs(a - b) < 1e-3;
  check(near(speeds[k]?.message.linear.x, column(row, "permitted_v_mps")), `row ${k}: speed`);
  check(near(Number(odom[k]?.time) * 1e-9, column(row, "t_s")), `row ${k}: time`);
});
for (const { message } of messages.get("/scan")) check(message.ranges.length > 2, "/scan without ranges");
console.log(failures ? `${failures} failures` : `mcap: ${[...counts].map(([t, n]) => `${t} ${n}`).join(", ")}`);
process.exit(failures ? 1 : 0);
