// node-canopen (npm) as the master of our emulated CiA 402 drive: identity, controlword by SDO, process data at SYNC,
// and what becomes of the drive when the master falls silent. usage: node canopen_peer.mjs DRIVE_PROGRAM
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { createInterface } from "node:readline";
import { setTimeout as after } from "node:timers/promises";
import canopen from "canopen";

const kNode = 0x11, kMaster = 0x05;
const { Device, DataType } = canopen;

const drive = spawn(process.argv[2], [String(kNode)], { stdio: ["pipe", "pipe", "inherit"] });
const seen = [];
const master = new Device({ id: kMaster });
master.addListener("message", ({ id, data }) => drive.stdin.write(`${id.toString(16)} ${data.toString("hex")}\n`));
const frames = createInterface({ input: drive.stdout });
frames.on("line", (line) => {
  const [id, bytes] = line.split(" ");
  const frame = { id: parseInt(id, 16), data: Buffer.from(bytes, "hex") };
  seen.push(frame);
  master.receive(frame);
});

const read = (index, subIndex, dataType) =>
  master.sdo.upload({ deviceId: kNode, index, subIndex, dataType, timeout: 500 });
const write = (index, subIndex, dataType, data) =>
  master.sdo.download({ deviceId: kNode, index, subIndex, dataType, data, timeout: 500 });
const statusword = () => read(0x6041, 0, DataType.UNSIGNED16);

async function until(what, holds) {
  for (let k = 0; k < 200; ++k, await after(10)) if (await holds()) return;
  assert.fail(what);
}

await once(frames, "line");
assert.deepEqual(seen[0], { id: 0x700 + kNode, data: Buffer.from([0]) }, "it says boot-up first");

master.eds.addSdoClientParameter(kNode, 0x600 + kNode, 0x580 + kNode);
master.eds.addHeartbeatConsumer(kNode, 500);
master.eds.addEmcyConsumer(0x80 + kNode);
master.eds.setHeartbeatProducerTime(20);
const status = master.eds.addEntry(0x2000, { parameterName: "statusword", dataType: DataType.UNSIGNED16 });
const speed = master.eds.addEntry(0x2001, { parameterName: "speed", dataType: DataType.INTEGER32 });
master.eds.addReceivePdo({ cobId: 0x180 + kNode, dataObjects: [status, speed] });
master.start();

// Identity (1018h): how many entries, vendor, product, revision, serial number; and what kind of device it is.
assert.equal(await read(0x1018, 0, DataType.UNSIGNED8), 4);
for (const [sub, value] of [[1, 0x2f7], [2, 0x402], [3, 0x10001], [4, 7]])
  assert.equal(await read(0x1018, sub, DataType.UNSIGNED32), value);
assert.equal((await read(0x1000, 0, DataType.UNSIGNED32)) & 0xffff, 402);
await assert.rejects(read(0x2fff, 0, DataType.UNSIGNED32), "what is not there is refused");
await assert.rejects(write(0x6041, 0, DataType.UNSIGNED16, 1), "what is read-only is refused");

// It watches the master, tells of itself, and shows statusword and speed at SYNC.
await write(0x1016, 1, DataType.UNSIGNED32, (kMaster << 16) | 200);
await write(0x1017, 0, DataType.UNSIGNED16, 50);
await write(0x6007, 0, DataType.INTEGER16, 3);
await write(0x1a00, 1, DataType.UNSIGNED32, 0x60410010);
await write(0x1a00, 2, DataType.UNSIGNED32, 0x606c0020);
await write(0x1a00, 0, DataType.UNSIGNED8, 2);
await write(0x1800, 2, DataType.UNSIGNED8, 1);
await write(0x1800, 1, DataType.UNSIGNED32, 0x180 + kNode);
const states = [];
master.nmt.on("heartbeat", ({ state }) => states.push(state));
master.nmt.startNode(kNode);
await until("it tells that it is operational", () => states.includes(5));

// Through the state machine by SDO alone: ready, switched on, enabled; and it turns.
await write(0x6060, 0, DataType.INTEGER8, 3);
assert.equal(await read(0x6061, 0, DataType.INTEGER8), 3);
for (const ramp of [0x6083, 0x6084, 0x6085]) await write(ramp, 0, DataType.UNSIGNED32, 20000);
for (const [controlword, state] of [[0x06, 0x21], [0x07, 0x23], [0x0f, 0x27]]) {
  await write(0x6040, 0, DataType.UNSIGNED16, controlword);
  assert.equal((await statusword()) & 0x6f, state);
}
await write(0x60ff, 0, DataType.INTEGER32, 5000);
await until("it turns at 5000 counts a second", async () => (await read(0x606c, 0, DataType.INTEGER32)) === 5000);
assert.ok((await read(0x6064, 0, DataType.INTEGER32)) > 0, "and its position grows");

// Process data: mapped as it was told. SYNC would also take the (empty) receive PDO over: enabled by it, too.
await write(0x1600, 1, DataType.UNSIGNED32, 0x60400010);
await write(0x1600, 2, DataType.UNSIGNED32, 0x60ff0020);
await write(0x1600, 0, DataType.UNSIGNED8, 2);
await write(0x1400, 1, DataType.UNSIGNED32, 0x200 + kNode);
const command = Buffer.alloc(6);
command.writeUInt16LE(0x0f, 0), command.writeInt32LE(-3000, 2);
const pdos = [];
master.pdo.on("pdo", () => pdos.push([status.value & 0x6f, speed.value]));
master.nmt.startNode();
const cycle = setInterval(() => {
  master.emit("message", { id: 0x200 + kNode, data: command });
  master.emit("message", { id: 0x080, data: Buffer.alloc(0) });
}, 10);
await until("PDOs at SYNC tell -3000", () => pdos.some(([state, value]) => state === 0x27 && value === -3000));
clearInterval(cycle);

// The master falls silent: the drive says 8130h, brakes and switches off by itself.
const emergencies = [];
master.emcy.on("emergency", ({ em }) => emergencies.push(em.code));
master.eds.setHeartbeatProducerTime(0);
await until("an emergency message", () => emergencies.includes(0x8130));
await until("it stands", async () => (await read(0x606c, 0, DataType.INTEGER32)) === 0);
assert.equal((await statusword()) & 0x4f, 0x40, "switched off");

console.log(`canopen: identity, ${seen.length} frames, ${pdos.length} PDOs, stop without the master: as expected`);
master.stop();
drive.stdin.end();
