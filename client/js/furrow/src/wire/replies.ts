// SPDX-License-Identifier: Apache-2.0
// The messages that a client receives, as plain objects. Every reader throws Malformed (protocol/STANDARD.md section
// 11): a message that fails a check is dropped as a whole.
import type { Server } from '../transport/transport.js';
import { FlatTable, require } from './flat_table.js';
import { namesHash } from './hash.js';
import { readTimecode, type Timecode } from './timecode.js';

export const MAX_NAMES = 2048;
const MAX_ERROR_BYTES = 1024;
const MAX_SERVER_BYTES = 64;
/** What the codes 1 to 16 of STANDARD.md section 10 mean. */
const ERROR_TEXTS = [
  'the daemon could not read the message', 'the daemon speaks another version of the protocol',
  'the daemon does not serve this request', 'the daemon does not have the subject', 'the pattern matches no weight',
  'a limit of the daemon is reached', 'the daemon refuses the skeleton', 'the daemon does not draw pictures',
  'the daemon does not have this size, view or camera', 'the daemon serves this over TCP only',
  'the daemon does not know this address', 'the daemon is shutting down',
  'an internal error of the daemon; see its log', 'another publisher is sending the subject',
  'the daemon requires a token', 'the token does not allow this',
];
const MAX_CODEC_BYTES = 32;
const MAX_OTHERS = 8;

export interface PictureMessage {
  width: number;
  height: number;
  /** Of a file; without meaning for a picture of a video. */
  mimeType: string;
  /** The codec of a video (RFC 6381), 'avc1.42c01f'. Empty: the bytes are a file. */
  codec: string;
  /** A picture of a video that needs no earlier one. */
  key: boolean;
  /** A copy, which outlives the message. */
  bytes: Uint8Array<ArrayBuffer>;
  ageUs: number;
  number: number;
  tier: number;
  still: boolean;
  dropped: number;
  /** On the daemon's clock. */
  receivedUs: number;
  /** Sequence of the request that defined the view. */
  viewRequest: number;
  /** Share of the width and height at which the scene was drawn, [1, 100]. Below 100, the picture is enlarged, with the help of former pictures if there are any. */
  drawnPercent: number;
}

export interface WeightsMessage {
  namesHash: bigint;
  /** Time without a new pose, microseconds; 0: a fresh pose. */
  ageUs: number;
  /** Each in [0, 1]. */
  values: Float32Array;
  /** Of the pose; null: its source sends none. */
  timecode: Timecode | null;
}

export interface ReplyMessage {
  /** Empty while the subscription waits for its subject. */
  subject: string;
  /** Equal names in equal order have equal hashes; 0n: no names. */
  namesHash: bigint;
  names: string[];
  /** Poses: changes with the session that sends them. Otherwise 0n. */
  publisherSession: bigint;
  /** Grows with each server of a cluster that gets the subject; 0n without a cluster. */
  epoch: bigint;
}

export function readPicture(payload: Uint8Array): PictureMessage {
  const table = new FlatTable(payload);
  const [width, height, format, tier] = [table.u16(0), table.u16(1), table.u8(2), table.u8(6)];
  require(width >= 1 && width <= 4096 && height >= 1 && height <= 4096, 'size of a picture');
  require(format <= 1 && tier <= 2, 'an unknown enumeration value');
  const bytes = table.bytes(4);
  require(bytes !== null, 'a picture without bytes');
  const [codec, still, key] = [table.text(11, MAX_CODEC_BYTES), table.flag(7), table.flag(12)];
  require(codec === '' ? !key : !still, 'a contradictory picture');
  const drawnPercent = table.u8(13, 100);
  require(drawnPercent >= 1 && drawnPercent <= 100, 'a share that is out of range');
  return {
    width,
    height,
    mimeType: format === 1 ? 'image/png' : 'image/jpeg',
    bytes: new Uint8Array(bytes),
    ageUs: Number(table.i64(3)),
    number: table.u32(5),
    tier,
    still,
    codec,
    key,
    dropped: table.u32(8),
    receivedUs: Number(table.i64(9)),
    viewRequest: table.u32(10),
    drawnPercent,
  };
}

export function readWeights(payload: Uint8Array): WeightsMessage {
  const table = new FlatTable(payload);
  const plain = table.vector(2, 4, MAX_NAMES);
  const packed = table.vector(3, 1, MAX_NAMES);
  require(plain === null || packed === null, 'both forms of one field');
  const found = plain ?? packed ?? { start: 0, count: 0 };
  const values = new Float32Array(found.count);
  for (let i = 0; i < found.count; ++i) {
    values[i] = plain !== null ? table.number(found.start + 4 * i) : payload[found.start + i]! / 255;
    require(values[i]! >= 0 && values[i]! <= 1, 'a weight outside 0 to 1');
  }
  const ageUs = Number(table.i64(1));
  require(ageUs >= 0, 'an age below 0');
  return { namesHash: table.u64(0), ageUs, values, timecode: readTimecode(table, 4) };
}

export function readReply(payload: Uint8Array): ReplyMessage {
  const table = new FlatTable(payload);
  const names = table.names(2, MAX_NAMES);
  const hash = table.u64(1);
  require(hash === namesHash(names), 'a hash that does not match the names');
  return { subject: table.text(0), namesHash: hash, names, publisherSession: table.u64(3), epoch: table.u64(4) };
}

/** The time of the sender, microseconds. A Pong repeats it. */
export function readPing(payload: Uint8Array): bigint {
  return new FlatTable(payload).i64(0);
}

export function readPong(payload: Uint8Array): { timeUs: number; serverTimeUs: number } {
  const table = new FlatTable(payload);
  return { timeUs: Number(table.i64(0)), serverTimeUs: Number(table.i64(1)) };
}

/** `others`: further servers of the daemon's cluster, "HOST:TCP:UDP". */
export function readWelcome(payload: Uint8Array): { server: string; token: bigint; others: string[] } {
  const table = new FlatTable(payload);
  return { server: table.text(0, MAX_SERVER_BYTES), token: table.u64(1), others: table.names(2, MAX_OTHERS) };
}

/** `code`: as in STANDARD.md section 10. `elsewhere`: the server to ask instead; null: none. */
export function readError(payload: Uint8Array): { code: number; message: string; elsewhere: Server | null } {
  const table = new FlatTable(payload);
  const code = table.u16(0);
  require(code >= 1 && code <= ERROR_TEXTS.length, 'an unknown error code');
  const [host, tcp, udp] = [table.text(2), table.u16(3), table.u16(4)];
  require(host === '' || (tcp !== 0 && udp !== 0), 'another server without ports');
  const elsewhere = { host, tcp, udp, web: table.u16(5), isWebTls: table.flag(6) };
  // A short datagram is answered by the code alone.
  const message = table.text(1, MAX_ERROR_BYTES) || ERROR_TEXTS[code - 1]!;
  return { code, message, elsewhere: host === '' ? null : elsewhere };
}

/** How many frames of a subscription with `every` the server has dropped since it began. */
export function readDropped(payload: Uint8Array): number {
  return Number(new FlatTable(payload).u64(0));
}

/** 0 done, 1 subject gone, 2 draining, 3 timed out. */
export function readGoodbye(payload: Uint8Array): number {
  const reason = new FlatTable(payload).u8(0);
  require(reason <= 3, 'an unknown reason');
  return reason;
}
