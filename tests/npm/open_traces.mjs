// Opens every trace of a folder with MCAP's reference readers, which verify every CRC on the way, and prints how many
// messages of /pose each holds, as JSON:
//   node open_traces.mjs FOLDER
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { decompress } from "fzstd";

const decompressHandlers = { zstd: (bytes) => decompress(bytes) };
const poses = {};
for (const name of readdirSync(process.argv[2]).filter((name) => name.endsWith(".mcap"))) {
  const file = readFileSync(join(process.argv[2], name));
  const stream = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  stream.append(file);
  let streamed = 0;
  let poseId;
  for (let record = stream.nextRecord(); record != undefined; record = stream.nextRecord()) {
    if (record.type === "Channel" && record.topic === "/pose") poseId = record.id;
    if (record.type === "Message" && record.channelId === poseId) ++streamed;
  }
  if (!stream.done()) throw new Error(`${name}: the streamed reader does not come to an end`);
  const readable = {
    size: async () => BigInt(file.length),
    read: async (offset, length) => new Uint8Array(file.subarray(Number(offset), Number(offset + length))),
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  let indexed = 0;
  for await (const message of reader.readMessages({ topics: ["/pose"] })) ++indexed;
  if (indexed !== streamed) throw new Error(`${name}: ${indexed} by index, ${streamed} streamed`);
  poses[name] = indexed;
}
console.log(JSON.stringify(poses));
