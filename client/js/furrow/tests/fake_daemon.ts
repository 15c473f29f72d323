// SPDX-License-Identifier: Apache-2.0
// A daemon, its network and a clock, all controlled by the test.
import { Builder, ByteBuffer } from 'flatbuffers';
import { Error as WireError } from '@wire/error';
import { Goodbye } from '@wire/goodbye';
import { Hello } from '@wire/hello';
import { Ping } from '@wire/ping';
import { Pong } from '@wire/pong';
import { SubscribeReply } from '@wire/subscribe-reply';
import { SubscribeWeights } from '@wire/subscribe-weights';
import { Timecode } from '@wire/timecode';
import { Weights } from '@wire/weights';
import { Welcome } from '@wire/welcome';
import type { Environment } from '../src/link/environment.js';
import type { Server, Transport, TransportEvents, TransportKind, TransportOpener } from '../src/transport/transport.js';
import { type Envelope, readMessage, writeMessage } from '../src/wire/envelope.js';
import { namesHash } from '../src/wire/hash.js';

/** A clock that only the test advances. */
export class FakeMachine implements Environment {
  private now = 0;
  private timers: { at: number; task: () => void }[] = [];

  nowMs(): number {
    return this.now;
  }

  after(ms: number, task: () => void): () => void {
    const timer = { at: this.now + ms, task };
    this.timers.push(timer);
    return () => {
      this.timers = this.timers.filter((each) => each !== timer);
    };
  }

  random(): number {
    return 0.5;
  }

  isAwake(): boolean {
    return true;
  }

  get numTimers(): number {
    return this.timers.length;
  }

  advance(ms: number): void {
    const end = this.now + ms;
    for (;;) {
      const next = this.timers.filter(({ at }) => at <= end).sort((a, b) => a.at - b.at)[0];
      if (next === undefined) break;
      this.timers = this.timers.filter((each) => each !== next);
      this.now = Math.max(this.now, next.at);
      next.task();
    }
    this.now = end;
  }
}

const TOKEN = 77n;

/** `isUp`: false: connections fail (TCP, WebSocket), or nobody answers (UDP). */
export class FakeDaemon implements TransportOpener {
  isUp = true;
  session = 0x3333n;
  /** Per subject: the names of its weights. Absent: the subject is not there. */
  readonly subjects = new Map<string, string[]>();
  /** Identifiers of all received messages. */
  received: string[] = [];
  /** The times of all Pongs, which answer challenges. */
  answers: bigint[] = [];
  /** Where subjects are that it does not have. */
  moved: Server | null = null;
  /** Of its right to serve. */
  epoch = 0n;
  /** Further servers of its cluster. */
  others: string[] = [];
  /** Drops everything that it would send. */
  isMute = false;
  events: TransportEvents | null = null;
  numOpened = 0;
  private isProven = false;
  /** Bytes that may go to an address that is not proven: as many as came from there. */
  private credit = 0;
  private readonly streams = new Map<string, number>();

  constructor(readonly kind: TransportKind) {}

  open(events: TransportEvents): Transport {
    this.events = events;
    ++this.numOpened;
    this.streams.clear();
    this.isProven = this.kind !== 'udp';
    queueMicrotask(() => {
      if (this.events !== events) return;
      if (this.kind === 'udp' || this.isUp) events.onOpen();
      else events.onClose('refused');
    });
    return {
      send: (message) => {
        if (this.isUp && this.events === events) this.handle(readMessage(message));
      },
      close: () => {
        if (this.events === events) this.events = null;
      },
    };
  }

  /** The daemon is killed, and forgets everything. */
  kill(): void {
    this.isUp = false;
    this.session += 1n;
    this.streams.clear();
    this.isProven = false;
    this.credit = 0;
    if (this.kind !== 'udp') this.events?.onClose('reset');
  }

  send(stream: number, sequence: number, payload: Uint8Array, captureTimeUs = 0n): void {
    if (this.isMute) return;
    const message = writeMessage({ stream, session: this.session, sequence }, payload);
    new DataView(message.buffer).setBigInt64(24, captureTimeUs, true);
    if (!this.isProven) {
      if (this.credit < message.length) return;
      this.credit -= message.length;
    }
    const { events } = this;
    queueMicrotask(() => {
      if (this.events === events) events?.onMessage(message);
    });
  }

  private handle(message: Envelope): void {
    this.received.push(message.identifier);
    this.credit += 32 + message.payload.length;
    if (message.identifier === 'FPIN') this.pong(message);
    if (message.identifier === 'FPON') this.answers.push(Pong.getRootAsPong(new ByteBuffer(message.payload)).timeUs());
    if (message.identifier === 'FHEL') this.welcome(message);
    if (message.identifier === 'FSUW') this.reply(message);
  }

  challenge(number: bigint): void {
    const builder = new Builder(32);
    Ping.finishPingBuffer(builder, Ping.createPing(builder, number));
    this.send(0, 0, builder.asUint8Array());
  }

  private welcome(message: Envelope): void {
    const token = Hello.getRootAsHello(new ByteBuffer(message.payload)).token();
    this.isProven ||= token === TOKEN;
    const builder = new Builder(64);
    const server = builder.createString('fake');
    const others = this.isProven ? Welcome.createOthersVector(builder, this.others.map((each) => builder.createString(each))) : 0;
    Welcome.finishWelcomeBuffer(builder, Welcome.createWelcome(builder, server, this.isProven ? 0n : TOKEN, others));
    this.send(0, message.sequence, builder.asUint8Array());
  }

  private pong(message: Envelope): void {
    const builder = new Builder(64);
    const time = Ping.getRootAsPing(new ByteBuffer(message.payload)).timeUs();
    Pong.finishPongBuffer(builder, Pong.createPong(builder, time, 5n));
    this.send(0, message.sequence, builder.asUint8Array());
  }

  private reply(message: Envelope): void {
    if (!this.isProven) {
      this.refuse(message.sequence, 11, 'unproven');
      return;
    }
    const subject = SubscribeWeights.getRootAsSubscribeWeights(new ByteBuffer(message.payload)).subject()!;
    const names = this.subjects.get(subject);
    if (names === undefined && this.moved !== null) {
      this.refuse(message.sequence, 4, 'elsewhere', this.moved);
      return;
    }
    const stream = this.streams.get(subject) ?? this.streams.size + 1;
    this.streams.set(subject, stream);
    this.sendNames(stream, message.sequence, subject, names ?? []);
  }

  sendNames(stream: number, sequence: number, subject: string, names: string[]): void {
    const builder = new Builder(256);
    const text = builder.createString(names.length > 0 ? subject : '');
    const list = SubscribeReply.createNamesVector(builder, names.map((name) => builder.createString(name)));
    SubscribeReply.finishSubscribeReplyBuffer(builder, SubscribeReply.createSubscribeReply(builder, text, namesHash(names), list, 0n, this.epoch));
    this.send(stream, sequence, builder.asUint8Array());
  }

  refuse(sequence: number, code: number, text: string, to: Server = { host: '', tcp: 0, udp: 0, web: 0, isWebTls: false }): void {
    const builder = new Builder(64);
    const words = builder.createString(text);
    const host = to.host === '' ? 0 : builder.createString(to.host);
    WireError.finishErrorBuffer(builder, WireError.createError(builder, code, words, host, to.tcp, to.udp, to.web, to.isWebTls));
    this.send(0, sequence, builder.asUint8Array());
  }

  goodbye(stream: number, reason: number): void {
    const builder = new Builder(64);
    Goodbye.finishGoodbyeBuffer(builder, Goodbye.createGoodbye(builder, reason));
    this.send(stream, 0, builder.asUint8Array());
  }

  /** Weights of a subject that is subscribed. `frame`: of its drop-frame timecode at 29.97; null: it has none. */
  weights(subject: string, sequence: number, values: number[], ageUs = 0n, frame: number | null = null): void {
    const stream = this.streams.get(subject);
    if (stream === undefined) return;
    const names = this.subjects.get(subject)!;
    const builder = new Builder(64);
    const list = Weights.createValuesVector(builder, values);
    Weights.startWeights(builder);
    Weights.addNamesHash(builder, namesHash(names));
    Weights.addAgeUs(builder, ageUs);
    Weights.addValues(builder, list);
    if (frame !== null) Weights.addTimecode(builder, Timecode.createTimecode(builder, frame, 30_000, 1001, 0, 1));
    Weights.finishWeightsBuffer(builder, Weights.endWeights(builder));
    this.send(stream, sequence, builder.asUint8Array(), BigInt(sequence) * 16_667n);
  }
}

/** Lets everything happen that is under way. */
export function settle(): Promise<void> {
  return new Promise((resolve) => setImmediate(resolve));
}
