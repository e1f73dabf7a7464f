// SPDX-License-Identifier: BSD-3-Clause
// Writes three messages on two topics with @mcap/core:
// node write_mcap.mjs FOLDER_WITH_NODE_MODULES chunks|no_chunks FILE.
import { createRequire } from "node:module";
import { writeFile } from "node:fs/promises";
import path from "node:path";

const [folder, how, file] = process.argv.slice(2);
const require = createRequire(path.join(path.resolve(folder), "any.js"));
const { McapWriter } = require("@mcap/core");

const parts = [];
let position = 0n;
const writable = {
  write: async (bytes) => {
    parts.push(Buffer.from(bytes));
    position += BigInt(bytes.length);
  },
  position: () => position,
};
const writer = new McapWriter({ writable, useChunks: how === "chunks" });
await writer.start({ profile: "", library: "test" });
const channels = {};
for (const topic of ["/a", "/b"])
  channels[topic] = await writer.registerChannel({ topic, messageEncoding: "json", schemaId: 0, metadata: new Map() });
let sequence = 0;
for (const [topic, text] of [["/a", "1"], ["/b", "2"], ["/a", "3"]])
  await writer.addMessage({
    channelId: channels[topic],
    sequence: sequence++,
    logTime: BigInt(sequence) * 1000000000n,
    publishTime: 0n,
    data: new TextEncoder().encode(text),
  });
await writer.end();
await writeFile(file, Buffer.concat(parts));
