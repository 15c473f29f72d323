// SPDX-License-Identifier: Apache-2.0
// The client's side of one secure session, without sockets and clocks (protocol/STANDARD.md section 15). It ends when
// the daemon was started again or is silent; its owner then makes another one.
import { randomBytes } from 'node:crypto';
import { type Bytes, Initiator, TAG_BYTES, KEY_BYTES } from './noise.js';
import { Opener, PACKET, Sealer } from './packets.js';
import { type Token, TOKEN_BYTES } from './token.js';

const INITIATION_BYTES = 1200;
const COOKIE_BYTES = 24;
const SHORT_HEADER_BYTES = 8;
const MESSAGE_AT = SHORT_HEADER_BYTES + TOKEN_BYTES + COOKIE_BYTES;
const PAYLOAD_BYTES = INITIATION_BYTES - MESSAGE_AT - KEY_BYTES - TAG_BYTES;
const RESPONSE_BYTES = 60;
const PROLOGUE = Buffer.from('furrow secure 1\n');
const FIRST_REPEAT_MS = 200;
const REPEAT_MS = 400;
const RETRY_MS = 20;
const PROBE_MS = 500;
const PROBE_REPEAT_MS = 200;
const RECONNECT_MS = 1500;
const LOST_MS = 10_000;
const CONTROL = { probe: 1, probeAnswer: 2, pathChallenge: 3, pathAnswer: 4, close: 7 } as const;
const UNKNOWN_SESSION = 1;
const BUSY = 8;
/** Of a Refused packet (section 15.1). */
const REASONS: Record<number, string> = {
  2: 'the server does not have the key of the token',
  3: 'the token or its key has expired',
  4: 'the token was changed, or sealed with another key',
  5: 'the token is for another server',
  6: 'the token is in use from another address',
  7: 'the handshake does not prove the key of the token',
  9: 'the server has no free session',
};

export interface SessionEvents {
  send(packet: Uint8Array): void;
  /** The session has begun. */
  onBegin(): void;
  /** An opened datagram of the daemon. */
  onDatagram(datagram: Uint8Array): void;
  /** There is no session, or none any more. `why`: one sentence. */
  onEnd(why: string): void;
}

interface Attempt {
  index: number;
  initiator: Initiator;
  datagram: Buffer;
  dueMs: number;
  repeatMs: number;
}

export class SecureSession {
  private cookie = Buffer.alloc(COOKIE_BYTES);
  private attempt: Attempt | null = null;
  private nextRetryMs = 0;
  private sealer: Sealer | null = null;
  private opener: Opener | null = null;
  private serverIndex = 0;
  private isUnknown = false;
  private heardMs = 0;
  private probeMs = 0;
  private isEnded = false;

  constructor(private readonly token: Token, private readonly events: SessionEvents) {}

  get isOpen(): boolean {
    return this.sealer !== null && !this.isEnded;
  }

  /** Call it about every 50 ms, and at first. */
  tick(nowMs: number): void {
    if (this.isEnded) return;
    const silence = nowMs - this.heardMs;
    if (this.isOpen && silence >= LOST_MS) return this.end('the daemon is silent');
    // A session that may be gone goes on until another handshake proves that the daemon does not know it.
    if (this.attempt === null && (!this.isOpen || this.isUnknown || silence >= RECONNECT_MS)) this.begin(nowMs);
    const { attempt } = this;
    if (attempt !== null && nowMs >= attempt.dueMs) {
      this.events.send(attempt.datagram);
      attempt.dueMs = nowMs + attempt.repeatMs;
      attempt.repeatMs = REPEAT_MS;
    }
    if (this.isOpen && nowMs >= this.probeMs) {
      this.probeMs = nowMs + PROBE_REPEAT_MS;
      this.control(CONTROL.probe, Buffer.alloc(COOKIE_BYTES), nowMs);
    }
  }

  /** Seals one datagram of the wire and sends it. Drops it without a session. */
  send(datagram: Bytes, nowMs: number): void {
    if (this.isOpen) this.events.send(this.sealer!.seal(PACKET.data, datagram, nowMs));
  }

  /** Tells the daemon that the session has ended. */
  close(nowMs: number): void {
    if (this.isOpen) this.control(CONTROL.close, Buffer.alloc(0), nowMs);
    this.isEnded = true;
  }

  received(packet: Bytes, nowMs: number): void {
    if (this.isEnded || packet.length < SHORT_HEADER_BYTES) return;
    const kind = packet[0]! & 0x7f;
    if (kind === PACKET.data || kind === PACKET.control) return this.onSealed(packet, nowMs);
    if (packet[1] !== 0 || packet[2] !== 0 || packet[3] !== 0) return;
    const index = new DataView(packet.buffer, packet.byteOffset).getUint32(4, true);
    const body = packet.subarray(SHORT_HEADER_BYTES);
    if (packet[0] === PACKET.retry) this.onRetry(index, body, nowMs);
    if (packet[0] === PACKET.response) this.onResponse(index, packet, nowMs);
    if (packet[0] === PACKET.refused && body.length === 4) this.onRefused(index, body[0]!);
  }

  private begin(nowMs: number): void {
    const head = Buffer.alloc(MESSAGE_AT);
    const index = randomBytes(4).readUInt32LE();
    head[0] = PACKET.initiation;
    head.writeUInt32LE(index, 4);
    head.set(this.token.bytes, SHORT_HEADER_BYTES);
    head.set(this.cookie, SHORT_HEADER_BYTES + TOKEN_BYTES);
    const initiator = new Initiator(this.token.key, Buffer.concat([PROLOGUE, head]));
    const datagram = Buffer.concat([head, initiator.write(Buffer.alloc(PAYLOAD_BYTES))]);
    this.attempt = { index, initiator, datagram, dueMs: nowMs, repeatMs: FIRST_REPEAT_MS };
  }

  private onRetry(index: number, cookie: Bytes, nowMs: number): void {
    if (this.attempt?.index !== index || cookie.length !== COOKIE_BYTES || nowMs < this.nextRetryMs) return;
    this.nextRetryMs = nowMs + RETRY_MS;
    this.cookie = Buffer.from(cookie);
    this.begin(nowMs);
    this.tick(nowMs);
  }

  private onResponse(index: number, packet: Bytes, nowMs: number): void {
    const { attempt } = this;
    if (attempt?.index !== index || packet.length !== RESPONSE_BYTES) return;
    const payload = attempt.initiator.read(packet.subarray(SHORT_HEADER_BYTES));
    if (payload === null) return;
    if (this.isOpen) return this.end('the daemon was started again');
    const { send, receive } = attempt.initiator.split();
    this.serverIndex = payload.readUInt32LE();
    this.sealer = new Sealer(send, this.serverIndex, nowMs);
    this.opener = new Opener(receive, index);
    this.attempt = null;
    this.heardMs = nowMs;
    this.probeMs = nowMs;
    this.tick(nowMs); // the session begins at the daemon with our first packet
    this.events.onBegin();
  }

  private onRefused(index: number, reason: number): void {
    if (reason === UNKNOWN_SESSION) {
      if (this.isOpen && index === this.serverIndex) this.isUnknown = true;
    } else if (this.attempt?.index === index && reason !== BUSY && !this.isOpen) {
      this.end(`the daemon refuses the token: ${REASONS[reason] ?? `reason ${reason}`}`);
    }
  }

  private onSealed(packet: Bytes, nowMs: number): void {
    const opened = this.opener?.open(packet, nowMs) ?? null;
    if (opened === null) return;
    this.heardMs = nowMs;
    this.probeMs = Math.max(this.probeMs, nowMs + PROBE_MS);
    this.attempt = null;
    this.isUnknown = false;
    if (opened.kind === PACKET.data) return this.events.onDatagram(opened.inner);
    const [type] = opened.inner;
    if (type === CONTROL.pathChallenge && opened.inner.length === 1 + COOKIE_BYTES) {
      this.control(CONTROL.pathAnswer, opened.inner.subarray(1), nowMs);
    }
    if (type === CONTROL.close) this.end('the daemon ended the session');
  }

  private control(type: number, content: Bytes, nowMs: number): void {
    this.events.send(this.sealer!.seal(PACKET.control, Buffer.concat([Buffer.of(type), content]), nowMs));
  }

  private end(why: string): void {
    this.isEnded = true;
    this.events.onEnd(why);
  }
}
