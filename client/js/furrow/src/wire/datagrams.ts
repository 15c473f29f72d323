// SPDX-License-Identifier: Apache-2.0
// Datagrams: bundles of messages, and fragments of one (protocol/STANDARD.md section 3).
import { ENVELOPE_BYTES, FLAG_FOLLOWED, FLAG_FRAGMENT, type Header, readHeader } from './envelope.js';
import { require } from './flat_table.js';

export const MAX_DATAGRAM_BYTES = 1200;
const MAX_FRAGMENTED_BYTES = 131_072;
const FRAGMENT_HEAD_BYTES = 40;
const SLICE_BYTES = MAX_DATAGRAM_BYTES - FRAGMENT_HEAD_BYTES;
const MAX_UNFINISHED_BYTES = 1_048_576;
const MAX_AGE_MS = 500;

/** Splits a datagram that holds several whole messages. Throws Malformed if any of them is invalid. */
export function splitBundle(datagram: Uint8Array): Uint8Array[] {
  const messages: Uint8Array[] = [];
  let session: bigint | null = null;
  for (let start = 0, more = true; more;) {
    const header = readHeader(datagram.subarray(start));
    require(header.flags !== FLAG_FRAGMENT, 'a fragment in a bundle');
    require(session === null || session === header.session, 'messages of two sessions');
    session = header.session;
    more = header.flags === FLAG_FOLLOWED;
    const end = start + ENVELOPE_BYTES + header.payloadBytes;
    require(header.payloadBytes >= 8 && end <= datagram.length, 'a message that ends outside its datagram');
    require(more || end === datagram.length, 'bytes behind the last message');
    const message = datagram.slice(start, end);
    message[5] = 0;
    messages.push(message);
    start = end;
  }
  return messages;
}

/** Splits a large message into datagrams. `id` differs between the messages of a session. */
export function splitMessage(message: Uint8Array, id: number): Uint8Array[] {
  if (message.length <= MAX_DATAGRAM_BYTES) return [message];
  const payload = message.subarray(ENVELOPE_BYTES);
  const count = Math.ceil(payload.length / SLICE_BYTES);
  return Array.from({ length: count }, (_, index) => {
    const slice = payload.subarray(SLICE_BYTES * index, SLICE_BYTES * (index + 1));
    const datagram = new Uint8Array(FRAGMENT_HEAD_BYTES + slice.length);
    datagram.set(message.subarray(0, ENVELOPE_BYTES));
    datagram[5] = FLAG_FRAGMENT;
    const view = new DataView(datagram.buffer);
    view.setUint32(32, id, true);
    view.setUint16(36, index, true);
    view.setUint16(38, count, true);
    datagram.set(slice, FRAGMENT_HEAD_BYTES);
    return datagram;
  });
}

interface Unfinished {
  header: Header;
  id: number;
  sinceMs: number;
  slices: (Uint8Array | undefined)[];
  missing: number;
}

function sameHeader(a: Header, b: Header): boolean {
  return a.stream === b.stream && a.session === b.session && a.sequence === b.sequence &&
    a.payloadBytes === b.payloadBytes && a.captureTimeUs === b.captureTimeUs;
}

/** Puts the messages of datagrams from one address together. */
export class Datagrams {
  private unfinished: Unfinished[] = [];

  /** The messages that a datagram completes. Throws Malformed. */
  accept(datagram: Uint8Array, nowMs: number): Uint8Array[] {
    require(datagram.length <= MAX_DATAGRAM_BYTES, 'a datagram above 1,200 bytes');
    const header = readHeader(datagram);
    if (header.flags !== FLAG_FRAGMENT) return splitBundle(datagram);
    const whole = this.addFragment(datagram, header, nowMs);
    return whole === null ? [] : [whole];
  }

  private addFragment(datagram: Uint8Array, header: Header, nowMs: number): Uint8Array | null {
    require(datagram.length >= FRAGMENT_HEAD_BYTES, 'a fragment without its head');
    const view = new DataView(datagram.buffer, datagram.byteOffset, datagram.byteLength);
    const id = view.getUint32(32, true);
    const index = view.getUint16(36, true);
    const size = header.payloadBytes;
    const count = Math.ceil(size / SLICE_BYTES);
    require(ENVELOPE_BYTES + size > MAX_DATAGRAM_BYTES, 'a fragment of a message that fits into a datagram');
    require(ENVELOPE_BYTES + size <= MAX_FRAGMENTED_BYTES, 'a fragmented message that is too large');
    require(view.getUint16(38, true) === count && index < count, 'a count that contradicts the payload size');
    require(datagram.length === FRAGMENT_HEAD_BYTES + Math.min(SLICE_BYTES, size - SLICE_BYTES * index),
      'a length that contradicts the payload size');
    this.unfinished = this.unfinished.filter((each) => nowMs - each.sinceMs <= MAX_AGE_MS);
    let message = this.unfinished.find((each) => each.id === id && each.header.session === header.session);
    if (message === undefined) {
      message = { header, id, sinceMs: nowMs, slices: new Array(count), missing: count };
      this.unfinished.push(message);
      let bytes = this.unfinished.reduce((sum, each) => sum + each.header.payloadBytes, 0);
      for (; bytes > MAX_UNFINISHED_BYTES; bytes -= this.unfinished.shift()!.header.payloadBytes);
    }
    require(sameHeader(message.header, header), 'fragments of different messages');
    if (message.slices[index] === undefined) --message.missing;
    message.slices[index] = datagram.slice(FRAGMENT_HEAD_BYTES);
    if (message.missing > 0) return null;
    this.unfinished = this.unfinished.filter((each) => each !== message);
    return join(datagram, message);
  }
}

function join(datagram: Uint8Array, message: Unfinished): Uint8Array {
  const whole = new Uint8Array(ENVELOPE_BYTES + message.header.payloadBytes);
  whole.set(datagram.subarray(0, ENVELOPE_BYTES));
  whole[5] = 0;
  message.slices.forEach((slice, index) => whole.set(slice!, ENVELOPE_BYTES + SLICE_BYTES * index));
  return whole;
}
