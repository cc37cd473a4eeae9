// Reads a trace with MCAP's reference reader, which verifies every CRC on the way, and prints what it saw as JSON:
//   node read_trace.mjs FILE.mcap
import { readFileSync } from "node:fs";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { decompress } from "fzstd";

const file = readFileSync(process.argv[2]);
const decompressHandlers = { zstd: (bytes) => decompress(bytes) };
const seen = { streamed: {}, indexed: {}, attachments: {}, metadata: {}, channels: {}, schemas: {} };

const stream = new McapStreamReader({ decompressHandlers, validateCrcs: true });
stream.append(file);
const topics = new Map();
for (let record = stream.nextRecord(); record != undefined; record = stream.nextRecord()) {
  if (record.type === "Channel") topics.set(record.id, record.topic);
  if (record.type === "Message") {
    const topic = topics.get(record.channelId);
    seen.streamed[topic] = (seen.streamed[topic] ?? 0) + 1;
  }
}
seen.done = stream.done();

const readable = {
  size: async () => BigInt(file.length),
  read: async (offset, length) => new Uint8Array(file.subarray(Number(offset), Number(offset + length))),
};
const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
seen.profile = reader.header.profile;
for (const channel of reader.channelsById.values()) {
  seen.channels[channel.topic] = { encoding: channel.messageEncoding, metadata: Object.fromEntries(channel.metadata) };
}
for (const schema of reader.schemasById.values()) {
  seen.schemas[schema.name] = { encoding: schema.encoding, bytes: schema.data.length };
}
let sequence = 0;
for await (const message of reader.readMessages()) {
  const topic = reader.channelsById.get(message.channelId).topic;
  seen.indexed[topic] = (seen.indexed[topic] ?? 0) + 1;
  sequence = Math.max(sequence, message.sequence);
}
seen.lastSequence = sequence;
for await (const attachment of reader.readAttachments({ validateCrcs: true })) {
  seen.attachments[attachment.name] = attachment.data.length;
}
for await (const metadata of reader.readMetadata()) {
  seen.metadata[metadata.name] = Object.fromEntries(metadata.metadata);
}
seen.messageCount = Number(reader.statistics.messageCount);
console.log(JSON.stringify(seen));
