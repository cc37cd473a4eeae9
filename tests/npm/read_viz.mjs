// Decodes what a trace shows viewers as Foxglove and Lichtblick do, by the schemas in the file, after comparing those
// of FlatBuffers with Foxglove's own; prints the messages as JSON:
//   node read_viz.mjs FILE.mcap
import { readFileSync } from "node:fs";
import { McapIndexedReader } from "@mcap/core";
import { decompress } from "fzstd";
import schemas from "@foxglove/schemas/internal.js";
import { ByteBuffer } from "flatbuffers";
import reflection from "flatbuffers_reflection";

const { foxgloveMessageSchemas, foxgloveEnumSchemas } = schemas;
const { Parser, Schema, Table, BaseType } = reflection;

/// Foxglove's primitive types as FlatBuffers has them.
const kBaseTypes = {
  float64: BaseType.Double,
  boolean: BaseType.Bool,
  string: BaseType.String,
  uint32: BaseType.UInt,
};

function check(condition, what) {
  if (!condition) throw new Error(what);
}

function named(name) {
  return foxgloveMessageSchemas[name.replace(/^foxglove\./, "")];
}

/// Every field of ours has the name, type and place that Foxglove's schema gives it, in all tables that it leads to.
function compareTable(schema, object, seen) {
  const name = object.name();
  if (seen.has(name)) return;
  seen.add(name);
  const expected = named(name);
  check(expected !== undefined, `Foxglove has no ${name}`);
  check(object.fieldsLength() === expected.fields.length, `${name} has other fields`);
  const ours = new Map();
  for (let i = 0; i < object.fieldsLength(); ++i) ours.set(object.fields(i).name(), object.fields(i));
  expected.fields.forEach((field, place) => {
    const what = `${name}.${field.name}`;
    const own = ours.get(field.name);
    check(own !== undefined, `there is no ${what}`);
    check(own.id() === place, `${what} has another place`);
    const isBytes = field.type.type === "primitive" && field.type.name === "bytes";
    const isVector = field.array !== undefined || isBytes;
    check((own.type().baseType() === BaseType.Vector) === isVector, `${what} is a list in one only`);
    const type = isVector ? own.type().element() : own.type().baseType();
    if (isBytes) {
      check(type === BaseType.UByte, `${what} holds no bytes`);
    } else if (field.type.type === "enum") {
      check(type === BaseType.UByte, `${what} is no enumeration`);
    } else if (field.type.type === "nested") {
      check(type === BaseType.Obj, `${what} is no table`);
      const nested = schema.objects(own.type().index());
      check(nested.name() === `foxglove.${field.type.schema.name}` || nested.isStruct(), `${what} is ${nested.name()}`);
      if (!nested.isStruct()) compareTable(schema, nested, seen);
    } else {
      check(type === kBaseTypes[field.type.name], `${what} is no ${field.type.name}`);
    }
  });
}

const file = readFileSync(process.argv[2]);
const readable = {
  size: async () => BigInt(file.length),
  read: async (offset, length) => new Uint8Array(file.subarray(Number(offset), Number(offset + length))),
};
const reader = await McapIndexedReader.Initialize({
  readable,
  decompressHandlers: { zstd: (bytes) => decompress(bytes) },
});

const decoders = new Map();
for (const channel of reader.channelsById.values()) {
  if (!channel.topic.startsWith("/viz/")) continue;
  const record = reader.schemasById.get(channel.schemaId);
  if (channel.messageEncoding === "json") {
    check(record.encoding === "jsonschema", `${channel.topic} has no JSON schema`);
    const text = new TextDecoder("utf-8", { fatal: true });
    check(JSON.parse(text.decode(record.data)).type === "object", `${channel.topic} holds no objects`);
    decoders.set(channel.id, { topic: channel.topic, schema: record.name, decode: (data) => JSON.parse(text.decode(data)) });
    continue;
  }
  check(channel.messageEncoding === "flatbuffer" && record.encoding === "flatbuffer", "it is no flatbuffer");
  const schema = Schema.getRootAsSchema(new ByteBuffer(record.data));
  check(schema.rootTable().name() === record.name, `the schema's root is not ${record.name}`);
  compareTable(schema, schema.rootTable(), new Set());
  for (let i = 0; i < schema.enumsLength(); ++i) {
    const own = schema.enums(i);
    const expected = Object.values(foxgloveEnumSchemas).find((one) => `foxglove.${one.name}` === own.name());
    check(own.valuesLength() === expected.values.length, `${own.name()} has other values`);
    expected.values.forEach((value, k) => check(own.values(k).name() === value.name, `${own.name()}.${value.name}`));
  }
  const parser = new Parser(schema);
  decoders.set(channel.id, {
    topic: channel.topic,
    schema: record.name,
    decode: (data) => parser.toObject(Table.getRootTable(new ByteBuffer(data)), true),
  });
}

const seen = {};
for await (const message of reader.readMessages()) {
  const known = decoders.get(message.channelId);
  if (known === undefined) continue;
  seen[known.topic] ??= { schema: known.schema, messages: [] };
  seen[known.topic].messages.push({ log_time: Number(message.logTime), ...known.decode(message.data) });
}
console.log(JSON.stringify(seen));
