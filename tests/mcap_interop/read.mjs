// SPDX-License-Identifier: Apache-2.0
// node read.mjs [--cut] FILE: prints every message of an MCAP file. Reads it with the stream reader of
// @mcap/core (which follows the records and verifies their checksums) and with its indexed reader (which
// follows the summary and the message indexes), and fails if they differ. --cut is for a file without an
// index, because its writer died: reads the records up to the last complete one. One line per message:
//   topic sequence log_time publish_time bytes crc32
// Sorted by (log time, topic, sequence, crc32), because readers may order equal times differently.
import { readFileSync } from "node:fs";
import { crc32 } from "@foxglove/crc";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import zstd from "@foxglove/wasm-zstd";
import lz4 from "@foxglove/wasm-lz4";

await zstd.isLoaded;
await lz4.isLoaded;
const decompressHandlers = {
  zstd: (bytes, size) => zstd.decompress(bytes, Number(size)),
  lz4: (bytes, size) => lz4(bytes, Number(size)),
};

function line(topic, message) {
  const { sequence, logTime, publishTime, data } = message;
  return `${topic} ${sequence} ${logTime} ${publishTime} ${data.byteLength} ${crc32(data)}`;
}

function inOrder(lines) {
  const keys = new Map(lines.map((text) => [text, text.split(" ")]));
  const time = (text) => BigInt(keys.get(text).at(-4));
  return lines.sort((a, b) => {
    if (time(a) !== time(b)) return time(a) < time(b) ? -1 : 1;
    return a < b ? -1 : a > b ? 1 : 0;
  });
}

const isCut = process.argv[2] === "--cut";
const bytes = readFileSync(process.argv.at(-1));

const streamed = [];
const channels = new Map();
const attachments = [];
const stream = new McapStreamReader({ decompressHandlers, validateCrcs: true });
stream.append(bytes);
for (let record; (record = stream.nextRecord()); ) {
  if (record.type === "Channel") channels.set(record.id, record.topic);
  if (record.type === "Message") streamed.push(line(channels.get(record.channelId), record));
  if (record.type === "Attachment")
    attachments.push(`attachment ${record.name} ${record.data.byteLength} ${crc32(record.data)}`);
}
if (isCut && stream.done()) {
  console.error("the file is complete; --cut is for truncated files");
  process.exit(1);
}

async function viaIndex() {
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => bytes.subarray(Number(offset), Number(offset + size)),
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  const lines = [];
  for await (const message of reader.readMessages({ validateCrcs: true }))
    lines.push(line(reader.channelsById.get(message.channelId).topic, message));
  for await (const { name, data } of reader.readAttachments())
    lines.push(`attachment ${name} ${data.byteLength} ${crc32(data)}`);
  return lines;
}

const found = [...inOrder(streamed), ...attachments];
if (!isCut) {
  const indexed = await viaIndex();
  if ([...indexed].sort().join("\n") !== [...found].sort().join("\n")) {
    console.error(`the index lists ${indexed.length} messages and attachments, the records hold ${found.length}`);
    process.exit(1);
  }
}
for (const text of found) console.log(text);
