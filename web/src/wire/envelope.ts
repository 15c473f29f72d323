// SPDX-License-Identifier: Apache-2.0
// The 32 bytes before every message (protocol/STANDARD.md section 2).

export const ENVELOPE_BYTES = 32;
const MAGIC = 0x57525246; // "FRRW" as a little-endian word
const VERSION = 1;

export interface Envelope {
  stream: number;
  session: bigint;
  sequence: number;
  /** Microseconds on the publisher's clock; 0 where there is none. */
  captureTimeUs: bigint;
  /** The payload's FlatBuffers file identifier, "FIMG". */
  identifier: string;
  payload: Uint8Array;
}

export interface Address {
  stream: number;
  session: bigint;
  sequence: number;
}

/** A message ready to be sent. */
export function writeMessage(to: Address, payload: Uint8Array): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(ENVELOPE_BYTES + payload.length);
  const view = new DataView(bytes.buffer);
  view.setUint32(0, MAGIC, true);
  view.setUint8(4, VERSION);
  view.setUint16(6, to.stream, true);
  view.setBigUint64(8, to.session, true);
  view.setUint32(16, to.sequence, true);
  view.setUint32(20, payload.length, true);
  bytes.set(payload, ENVELOPE_BYTES);
  return bytes;
}

/** What a message says of itself, or null where the bytes are none. */
export function readMessage(data: ArrayBuffer): Envelope | null {
  if (data.byteLength < ENVELOPE_BYTES + 8) return null;
  const view = new DataView(data);
  if (view.getUint32(0, true) !== MAGIC || view.getUint8(4) !== VERSION) return null;
  if (view.getUint32(20, true) !== data.byteLength - ENVELOPE_BYTES) return null;
  const payload = new Uint8Array(data, ENVELOPE_BYTES);
  return {
    stream: view.getUint16(6, true),
    session: view.getBigUint64(8, true),
    sequence: view.getUint32(16, true),
    captureTimeUs: view.getBigInt64(24, true),
    identifier: String.fromCharCode(...payload.subarray(4, 8)),
    payload,
  };
}
