// SPDX-License-Identifier: Apache-2.0
// The 32 bytes before every message (protocol/STANDARD.md section 2).
import { require } from './flat_table.js';

export const ENVELOPE_BYTES = 32;
/** Largest message from a daemon (section 11). */
export const MAX_REPLY_BYTES = 16_777_216;
const MAGIC = 0x57525246; // "FRRW" as a little-endian word
const VERSION = 1;
const MAX_TIME_US = 1n << 62n;

export const FLAG_FRAGMENT = 1;
export const FLAG_FOLLOWED = 2;

export interface Header {
  /** 0, FLAG_FRAGMENT or FLAG_FOLLOWED. */
  flags: number;
  stream: number;
  session: bigint;
  sequence: number;
  /** Of the whole payload, also in a fragment. */
  payloadBytes: number;
  /** Microseconds on the publisher's clock; 0n where there is none. */
  captureTimeUs: bigint;
}

export interface Envelope extends Header {
  /** The payload's FlatBuffers file identifier, "FIMG". */
  identifier: string;
  payload: Uint8Array;
}

export interface Destination {
  stream: number;
  session: bigint;
  sequence: number;
}

function viewOf(bytes: Uint8Array): DataView {
  return new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
}

/** A message ready to be sent. */
export function writeMessage(to: Destination, payload: Uint8Array): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(ENVELOPE_BYTES + payload.length);
  const view = viewOf(bytes);
  view.setUint32(0, MAGIC, true);
  view.setUint8(4, VERSION);
  view.setUint16(6, to.stream, true);
  view.setBigUint64(8, to.session, true);
  view.setUint32(16, to.sequence, true);
  view.setUint32(20, payload.length, true);
  bytes.set(payload, ENVELOPE_BYTES);
  return bytes;
}

/** Reads and checks an envelope; throws Malformed. */
export function readHeader(bytes: Uint8Array): Header {
  require(bytes.length >= ENVELOPE_BYTES, 'shorter than an envelope');
  const view = viewOf(bytes);
  require(view.getUint32(0, true) === MAGIC, 'wrong magic');
  require(view.getUint8(4) === VERSION, 'unsupported version');
  const header = {
    flags: view.getUint8(5),
    stream: view.getUint16(6, true),
    session: view.getBigUint64(8, true),
    sequence: view.getUint32(16, true),
    payloadBytes: view.getUint32(20, true),
    captureTimeUs: view.getBigInt64(24, true),
  };
  require(header.flags <= FLAG_FOLLOWED, 'undefined flags, or both flags together');
  require(header.session !== 0n, 'session 0');
  require(header.captureTimeUs > -MAX_TIME_US && header.captureTimeUs < MAX_TIME_US, 'capture time out of range');
  return header;
}

/** Reads one whole message; throws Malformed. The payload is a part of `bytes`. */
export function readMessage(bytes: Uint8Array): Envelope {
  require(bytes.length <= MAX_REPLY_BYTES, 'too large');
  const header = readHeader(bytes);
  require(header.flags === 0, 'a fragment or a bundle instead of a message');
  const payload = bytes.subarray(ENVELOPE_BYTES);
  require(payload.length === header.payloadBytes && payload.length >= 8, 'payload size and byte count differ');
  return { ...header, identifier: String.fromCharCode(...payload.subarray(4, 8)), payload };
}
