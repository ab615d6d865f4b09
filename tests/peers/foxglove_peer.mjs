// Looks at a running `jaywalk sim --view` with Foxglove's own WebSocket client, by either subprotocol: every message decoded
// by the schema that was advertised and encoded again to the same bytes; then publishes a goal, at which the robot arrives.
// usage: node foxglove_peer.mjs JAYWALK SCENARIO OUT
import foxglove from "@foxglove/ws-protocol";
import { parse } from "@foxglove/rosmsg";
import { MessageReader, MessageWriter } from "@foxglove/rosmsg2-serialization";
import { spawn } from "node:child_process";
import { createInterface } from "node:readline";
import WebSocket from "ws";

const [jaywalk, scenario, out] = process.argv.slice(2);
const topics = ["/scan", "/points", "/odom", "/tf", "/map", "/plan", "/goal_pose", "/tracks", "/diagnostics", "/cmd_vel", "/tf_static", "/clock", "/joint_states"];
const fail = (what) => { console.log(`FAILED: ${what}`); process.exit(1); };
const run = spawn(jaywalk, ["sim", scenario, "--view", "--until-arrived", "--out", out], { stdio: ["ignore", "pipe", "inherit"] });
process.on("exit", () => run.kill("SIGKILL"));
const exited = new Promise((done) => run.on("exit", done));
const address = await new Promise((found) => createInterface(run.stdout).on("line", (line) => {
  if (line.startsWith("view: ")) found(line.slice(6).replace("http", "ws"));
}));
setTimeout(() => fail("nothing more happens"), 120000).unref();

// Resolves with counts by topic once each topic has come; calls `next` with each message then.
const look = (protocol, next) => new Promise((done) => {
  const client = new foxglove.FoxgloveClient({ ws: new WebSocket(address, [protocol]) });
  const counts = new Map(), of = new Map();
  client.on("error", (error) => fail(`${protocol}: ${error.message}`));
  client.on("status", (status) => fail(`${protocol}: ${status.message}`));
  client.on("serverInfo", (info) => info.capabilities.includes("clientPublish") || fail("takes nothing that is published"));
  client.on("advertise", (channels) => {
    if (channels.map((c) => c.topic).sort().join() !== [...topics].sort().join()) fail(`channels: ${channels.map((c) => c.topic)}`);
    for (const channel of channels) {
      const definitions = parse(channel.schema, { ros2: true });
      of.set(client.subscribe(channel.id), { topic: channel.topic, reader: new MessageReader(definitions), writer: new MessageWriter(definitions), definitions });
    }
  });
  client.on("message", ({ subscriptionId, timestamp, data }) => {
    const { topic, reader, writer, definitions } = of.get(subscriptionId);
    const message = reader.readMessage(data);
    if (Buffer.compare(Buffer.from(writer.writeMessage(message)), Buffer.from(data.buffer, data.byteOffset, data.byteLength)) !== 0) fail(`${topic}: encodes to other bytes`);
    if (topic === "/odom" && BigInt(message.header.stamp.sec) * 1000000000n + BigInt(message.header.stamp.nanosec) !== timestamp) fail("/odom: stamps differ");
    counts.set(topic, (counts.get(topic) ?? 0) + 1);
    if (counts.size === topics.length) next({ client, counts, topic, message, definitions, done });
  });
});

const first = await look("foxglove.websocket.v1", ({ client, counts, done }) => { client.close(); done(counts); });
let channel, goal;
const second = await look("foxglove.sdk.v1", ({ client, counts, topic, message, done }) => {
  if (topic === "/tf" && !goal) {  // 1.5 m ahead of base_link, by way of odom
    const turn = ({ rotation: q }) => 2 * Math.atan2(q.z, q.w);
    const [first, second] = message.transforms.map((t) => t.transform), a = turn(first), b = a + turn(second);
    const { x, y } = second.translation;
    goal = { x: first.translation.x + Math.cos(a) * x - Math.sin(a) * y + 1.5 * Math.cos(b), y: first.translation.y + Math.sin(a) * x + Math.cos(a) * y + 1.5 * Math.sin(b) };
    channel = client.advertise({ topic: "/goal_pose", encoding: "json", schemaName: "geometry_msgs/PoseStamped" });
    client.sendMessage(channel, new TextEncoder().encode(JSON.stringify({ header: { frame_id: "map" }, pose: { position: goal } })));
  }
  if (topic !== "/goal_pose" || !goal || Math.hypot(message.pose.position.x - goal.x, message.pose.position.y - goal.y) > 1e-3) return;
  client.close();
  done(counts);
});
const code = await exited;
const told = (counts) => [...counts].map(([topic, n]) => `${topic} ${n}`).join(", ");
console.log(`foxglove.websocket.v1: ${told(first)}\nfoxglove.sdk.v1: ${told(second)}\nthe published goal was taken; the run ended with ${code}`);
process.exit(code === 0 ? 0 : 1);
