// SPDX-License-Identifier: Apache-2.0
// node write.mjs IN OUT none|zstd|lz4: copies the messages of the MCAP file IN to OUT with the writer of
// @mcap/core, in small chunks.
import { readFileSync, writeFileSync } from "node:fs";
import { McapIndexedReader, McapWriter } from "@mcap/core";
import zstd from "@foxglove/wasm-zstd";
import lz4 from "lz4js";

await zstd.isLoaded;
const [input, output, compression] = process.argv.slice(2);
const pack = { zstd: (data) => zstd.compress(data), lz4: (data) => lz4.compress(data) }[compression];

const bytes = readFileSync(input);
const reader = await McapIndexedReader.Initialize({
  readable: {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => bytes.subarray(Number(offset), Number(offset + size)),
  },
  decompressHandlers: { zstd: (data, size) => zstd.decompress(data, Number(size)) },
});
const parts = [];
let size = 0;
const writer = new McapWriter({
  writable: {
    write: async (part) => {
      parts.push(part.slice());
      size += part.byteLength;
    },
    position: () => BigInt(size),
  },
  chunkSize: 20000,
  compressChunk: pack && ((data) => ({ compression, compressedData: pack(data) })),
});
await writer.start({ profile: "", library: "interop" });
const schemas = new Map([[0, 0]]);
for (const [id, schema] of reader.schemasById) schemas.set(id, await writer.registerSchema(schema));
const channels = new Map();
for (const [id, channel] of reader.channelsById)
  channels.set(id, await writer.registerChannel({ ...channel, schemaId: schemas.get(channel.schemaId) }));
for await (const message of reader.readMessages())
  await writer.addMessage({ ...message, channelId: channels.get(message.channelId) });
await writer.end();
writeFileSync(output, Buffer.concat(parts));
