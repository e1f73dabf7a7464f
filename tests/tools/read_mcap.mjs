// SPDX-License-Identifier: BSD-3-Clause
// Reads an MCAP file with @mcap/core, once by its index and once from the front to the end with all
// checksums: node read_mcap.mjs FOLDER_WITH_NODE_MODULES FILE. Prints one JSON object.
import { createRequire } from "node:module";
import { open, readFile } from "node:fs/promises";
import path from "node:path";

const [folder, file] = process.argv.slice(2);
const require = createRequire(path.join(path.resolve(folder), "any.js"));
const { McapIndexedReader, McapStreamReader } = require("@mcap/core");

async function openReadable(name) {
  const handle = await open(name);
  return {
    size: async () => BigInt((await handle.stat()).size),
    read: async (offset, length) => {
      const bytes = new Uint8Array(Number(length));
      await handle.read(bytes, 0, bytes.length, Number(offset));
      return bytes;
    },
  };
}

const text = (bytes) => new TextDecoder().decode(bytes);
const reader = await McapIndexedReader.Initialize({ readable: await openReadable(file) });
const topicOf = (id) => reader.channelsById.get(id).topic;

const out = { chunks: reader.chunkIndexes.length, topics: {}, messages: [], streamed: 0, late: 0 };
for (const channel of reader.channelsById.values()) {
  const schema = reader.schemasById.get(channel.schemaId);
  out.topics[channel.topic] = {
    encoding: channel.messageEncoding,
    schema: schema.name,
    schemaEncoding: schema.encoding,
    schemaText: JSON.parse(text(schema.data)),
    count: Number(reader.statistics.channelMessageCounts.get(channel.id)),
  };
}
for await (const m of reader.readMessages()) {
  out.messages.push({
    topic: topicOf(m.channelId),
    sequence: m.sequence,
    logTime: String(m.logTime),
    publishTime: String(m.publishTime),
    text: text(m.data),
  });
}
// From the middle on, which is what an index is for.
if (out.messages.length > 0) {
  const startTime = BigInt(out.messages[out.messages.length >> 1].logTime);
  for await (const m of reader.readMessages({ startTime })) out.late += m.logTime >= startTime ? 1 : -1e9;
}

const stream = new McapStreamReader({ validateCrcs: true });
stream.append(await readFile(file));
for (let record; (record = stream.nextRecord()); ) out.streamed += record.type === "Message" ? 1 : 0;
out.whole = stream.done();
console.log(JSON.stringify(out));
