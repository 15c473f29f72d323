// SPDX-License-Identifier: Apache-2.0
// node read.mjs FILE: every message of an MCAP file, by @mcap/core's indexed reader (which goes by
// the summary and the message indexes) and again by its stream reader (which goes by the records and
// checks their checksums); fails where the two do not agree. A line each:
//   topic sequence log_time publish_time bytes crc32
// In the order of (log time, topic, sequence, crc32), since readers may differ where times are equal.
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

const bytes = readFileSync(process.argv[2]);
const readable = {
  size: async () => BigInt(bytes.length),
  read: async (offset, size) => bytes.subarray(Number(offset), Number(offset + size)),
};
const indexed = [];
const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
for await (const message of reader.readMessages({ validateCrcs: true }))
  indexed.push(line(reader.channelsById.get(message.channelId).topic, message));

const streamed = [];
const channels = new Map();
const stream = new McapStreamReader({ decompressHandlers, validateCrcs: true });
stream.append(bytes);
for (let record; (record = stream.nextRecord()); ) {
  if (record.type === "Channel") channels.set(record.id, record.topic);
  if (record.type === "Message") streamed.push(line(channels.get(record.channelId), record));
}
const [a, b] = [inOrder(indexed), inOrder(streamed)];
if (a.join("\n") !== b.join("\n")) {
  console.error(`the index leads to ${a.length} messages, the records hold ${b.length}`);
  process.exit(1);
}
for (const text of a) console.log(text);
for await (const attachment of reader.readAttachments())
  console.log(`attachment ${attachment.name} ${attachment.data.byteLength} ${crc32(attachment.data)}`);
