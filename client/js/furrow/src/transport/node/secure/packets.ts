// SPDX-License-Identifier: Apache-2.0
// Data and control packets of a secure session (protocol/STANDARD.md section 15.2).
import { type Bytes, open, seal, TAG_BYTES } from './noise.js';

export const HEADER_BYTES = 16;
export const PACKET = { initiation: 1, retry: 2, response: 3, refused: 4, data: 5, control: 6 } as const;
export type SealedKind = typeof PACKET.data | typeof PACKET.control;

const PHASE_BIT = 0x80;
const MAX_INNER_BYTES = 1200;
const WINDOW = 1024;
const REKEY_PACKETS = 2 ** 24;
const REKEY_MS = 15 * 60_000;
const OLD_KEY_MS = 2000;
const REKEY_NONCE = 2n ** 64n - 1n;
const NO_BYTES = new Uint8Array(0);

/** Noise's REKEY. */
const nextKey = (key: Bytes): Buffer => seal(key, REKEY_NONCE, NO_BYTES, new Uint8Array(32)).subarray(0, 32);

export class Sealer {
  private counter = 0n;
  private phase = 0;
  private numInPhase = 0;

  /** `index`: of the session at the receiver. */
  constructor(private key: Bytes, private readonly index: number, private phaseBeganMs: number) {}

  seal(kind: SealedKind, inner: Bytes, nowMs: number): Buffer {
    if (this.numInPhase >= REKEY_PACKETS || nowMs - this.phaseBeganMs >= REKEY_MS) {
      this.key = nextKey(this.key);
      this.phase ^= PHASE_BIT;
      this.numInPhase = 0;
      this.phaseBeganMs = nowMs;
    }
    const header = Buffer.alloc(HEADER_BYTES);
    header[0] = kind | this.phase;
    header.writeUInt32LE(this.index, 4);
    header.writeBigUInt64LE(this.counter, 8);
    ++this.numInPhase;
    return Buffer.concat([header, seal(this.key, this.counter++, header, inner)]);
  }
}

/** Which of the newest counters were received. */
class ReplayWindow {
  private readonly received = new Uint8Array(WINDOW);
  private newest = -1n;

  isNew(counter: bigint): boolean {
    if (counter > this.newest) return true;
    return this.newest - counter < BigInt(WINDOW) && this.received[placeOf(counter)] === 0;
  }

  mark(counter: bigint): void {
    const ahead = counter - this.newest;
    if (ahead >= BigInt(WINDOW)) this.received.fill(0);
    else for (let c = this.newest + 1n; c < counter; ++c) this.received[placeOf(c)] = 0;
    if (ahead > 0n) this.newest = counter;
    this.received[placeOf(counter)] = 1;
  }
}

const placeOf = (counter: bigint): number => Number(counter & BigInt(WINDOW - 1));

export class Opener {
  private former: Bytes | null = null;
  private next: Bytes;
  private phase = 0;
  private firstOfPhase = 0n;
  private turnedMs = 0;
  private readonly window = new ReplayWindow();

  constructor(private key: Bytes, private readonly index: number) {
    this.next = nextKey(key);
  }

  /** The kind and the inner bytes of a packet; null if it is not an authentic and new one of this session. */
  open(packet: Bytes, nowMs: number): { kind: number; inner: Buffer } | null {
    const size = packet.length - HEADER_BYTES - TAG_BYTES;
    if (size < 0 || size > MAX_INNER_BYTES || packet[1] !== 0 || packet[2] !== 0 || packet[3] !== 0) return null;
    const view = new DataView(packet.buffer, packet.byteOffset, HEADER_BYTES);
    const counter = view.getBigUint64(8, true);
    if (view.getUint32(4, true) !== this.index || counter === REKEY_NONCE || !this.window.isNew(counter)) return null;
    const phase = packet[0]! & PHASE_BIT;
    const isFormer = phase !== this.phase && this.former !== null && counter < this.firstOfPhase;
    if (isFormer && nowMs - this.turnedMs > OLD_KEY_MS) return null;
    const key = phase === this.phase ? this.key : isFormer ? this.former! : this.next;
    const inner = open(key, counter, packet.subarray(0, HEADER_BYTES), packet.subarray(HEADER_BYTES));
    if (inner === null) return null;
    // Only an authentic packet changes anything.
    this.window.mark(counter);
    if (key === this.next) {
      this.former = this.key;
      this.key = this.next;
      this.next = nextKey(this.key);
      this.phase = phase;
      this.firstOfPhase = counter;
      this.turnedMs = nowMs;
    }
    return { kind: packet[0]! & ~PHASE_BIT, inner };
  }
}
