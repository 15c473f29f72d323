// SPDX-License-Identifier: Apache-2.0
// One connection to a daemon for all subscriptions. It opens by itself, and again after every loss, and subscribes
// again then (protocol/STANDARD.md sections 4 and 8).
import type { Server, Transport, TransportKind, TransportOpener } from '../transport/transport.js';
import { type Envelope, readMessage, writeMessage } from '../wire/envelope.js';
import { Malformed } from '../wire/flat_table.js';
import { readError, readGoodbye, readPing, readPong, readReply, readWelcome, type ReplyMessage } from '../wire/replies.js';
import { hello, ping, pong, unsubscribe } from '../wire/requests.js';
import { Backoff } from './backoff.js';
import { ServerClock } from './clock.js';
import { type Environment, MACHINE } from './environment.js';
import { Servers, webAddress } from './servers.js';

/** A datagram may be lost, so requests and the Hello are repeated. */
const REPEAT_MS = 200;
/** A silent daemon is asked less often. */
const SLOW_REPEAT_MS = 1000;
const SLOW_AFTER_MS = 5000;
/** Over UDP, pings also find a restarted daemon, which may answer the second one only (section 4). */
const PING_MS = { ws: 1000, tcp: 1000, udp: 400 } as const;
/** The connection counts as lost after this time without a message. Pongs arrive with every ping. */
const SILENCE_MS = 5000;
/** An attempt that takes longer has failed. */
const CONNECT_MS = 3000;
/** A message that arrives this long after opening proves that the connection works. An earlier one may be a refusal. */
const PROVEN_MS = 1000;
/** The same as SILENCE_MS if there are other servers to go to. */
const SILENCE_WITH_OTHERS_MS = 2000;
/** A client that was sent elsewhere, but stays, asks again after this time. */
const STAY_MS = 800;
const MAX_CLIENT_BYTES = 64;

/** Codes of STANDARD.md section 10. */
export const ERROR = { unsupported: 3, unknownSubject: 4, noMatch: 5, limit: 6, notRendering: 8, badPicture: 9, unproven: 11, draining: 12,
  needsToken: 15, notPermitted: 16 } as const;
/** Reasons of a Goodbye. */
const DONE = 0;
const SUBJECT_GONE = 1;
const DRAINING = 2;
const TIMED_OUT = 3;

/** The request of a subscription and its callbacks. Callbacks of one subscription may throw Malformed. */
export interface Subscriber {
  /** The subject that it asks for. Absent: the connection stays at its server. */
  asksFor?(): string;
  /**
   * Another server of the cluster serves the subject, and the connection stays at this one. `web`: the address of the
   * other one's web server, "https://host:7480". Called instead of onRefused(), if the other server has a web server.
   */
  onElsewhere?(web: string): void;
  /** Returns the current request. Called for every connection. */
  request(): Uint8Array;
  onReply(reply: ReplyMessage, requestSequence: number): void;
  onMessage(message: Envelope): void;
  /** The subject left. The subscription waits for it. */
  onGone(): void;
  /** The daemon rejected a request, or ended the subscription (`code` 0). `sequence`: that of the rejected request. */
  onRefused(code: number, message: string, sequence: number): void;
}

/** Handle of a subscription. */
export interface Subscription {
  /** Sends a message on the subscription's stream. Returns its sequence, or null if it was not sent. */
  send(payload: Uint8Array): number | null;
  close(): void;
  /** Subscribes again, for example after a rejection. */
  askAgain(): void;
  /** Asks for the reply once more, because it seems to be lost. Does not make a second subscription. */
  repeat(): void;
}

/** 'lost': also if the first attempt failed. 'draining': the daemon is shutting down. */
export type LinkState = 'connecting' | 'open' | 'lost' | 'draining';

interface Entry {
  subscriber: Subscriber;
  /** Sequence of the subscribing request, which the reply repeats. */
  sequence: number;
  message: Uint8Array<ArrayBuffer> | null;
  /** True while the daemon owes a reply. */
  waiting: boolean;
  /** 0 until the daemon has replied. */
  stream: number;
  /** Sequences of requests about the subscription, to assign errors to it. */
  requests: Set<number>;
  /** The subject that was served last, and the highest epoch in which it was. */
  served: string;
  epoch: bigint;
  /** The server serves a lower epoch than another one did. It will notice that it no longer may. */
  isFenced: boolean;
}

export interface ConnectionOptions {
  /** Of this program, for the daemon's log; at most 64 bytes. */
  program?: string;
  environment?: Environment;
}

export class Connection {
  readonly clock = new ServerClock();
  readonly kind: TransportKind;
  private readonly environment: Environment;
  private readonly backoff: Backoff;
  private readonly program: string;
  private readonly session: bigint;
  private readonly servers: Servers;
  private readonly stateListeners = new Set<(state: LinkState) => void>();
  private readonly entries = new Set<Entry>();
  private current: LinkState = 'connecting';
  private transport: Transport | null = null;
  private isUp = false;
  /** UDP: the daemon has accepted our address. Streams need no proof. */
  private isProven = false;
  private token = 0n;
  private serverSession = 0n;
  private sequence = 0;
  private openedMs = 0;
  private upMs = 0;
  private heardMs = 0;
  private sentMs = 0;
  private numConnects = 0;
  private numMalformed = 0;
  private failure = '';
  private cancelTimer: () => void = () => {};
  private isClosed = false;

  constructor(opener: TransportOpener, options: ConnectionOptions = {}) {
    this.servers = new Servers(opener);
    this.kind = opener.kind;
    this.environment = options.environment ?? MACHINE;
    this.backoff = new Backoff(this.environment.random);
    this.program = cut(options.program ?? 'furrow.js', MAX_CLIENT_BYTES);
    this.session = opener.makeSession?.() || randomSession(this.environment.random);
    this.connect();
  }

  /** Time since the daemon's last message, milliseconds; 0 unless the connection is open. */
  get silentMs(): number {
    return this.isUp ? Math.max(0, this.environment.nowMs() - this.heardMs) : 0;
  }

  get state(): LinkState {
    return this.current;
  }

  /** How often the daemon was reached. */
  get connects(): number {
    return this.numConnects;
  }

  /** Messages that were dropped because they were malformed. */
  get malformed(): number {
    return this.numMalformed;
  }

  /** Why the connection was lost, or does not open; empty if nobody said. */
  get lastFailure(): string {
    return this.failure;
  }

  /** Calls the listener on every change. Returns a function that removes the listener. */
  onState(listener: (state: LinkState) => void): () => void {
    this.stateListeners.add(listener);
    return () => this.stateListeners.delete(listener);
  }

  /** Microseconds on our own clock, the one of `clock`. */
  nowUs(): number {
    return Math.round(this.environment.nowMs() * 1000);
  }

  nowMs(): number {
    return this.environment.nowMs();
  }

  after(ms: number, task: () => void): () => void {
    return this.environment.after(ms, task);
  }

  /** Sends the request now if the connection is open, otherwise once it is. */
  subscribe(subscriber: Subscriber): Subscription {
    const entry: Entry = { subscriber, sequence: 0, message: null, waiting: false, stream: 0, requests: new Set(),
      served: '', epoch: 0n, isFenced: false };
    this.entries.add(entry);
    if (this.isProven) this.ask(entry);
    return {
      send: (payload) => this.sendAbout(entry, payload),
      close: () => this.end(entry),
      askAgain: () => {
        if (this.isProven && this.entries.has(entry)) this.ask(entry);
      },
      repeat: () => {
        // Streams lose nothing, so the reply is only late there.
        if (this.kind === 'udp' && entry.message !== null) entry.waiting = true;
      },
    };
  }

  /** Ends all subscriptions and the connection, which cannot be used again. */
  close(): void {
    if (this.isClosed) return;
    this.isClosed = true;
    for (const entry of this.entries) this.end(entry);
    this.cancelTimer();
    this.transport?.close();
    this.transport = null;
    this.isUp = this.isProven = false;
    this.setState('lost');
    this.stateListeners.clear();
  }

  private setState(state: LinkState): void {
    if (state === this.current) return;
    this.current = state;
    for (const listener of [...this.stateListeners]) listener(state);
  }

  private connect(): void {
    if (this.isClosed) return;
    this.openedMs = this.environment.nowMs();
    const events = {
      onOpen: () => this.opened(),
      onMessage: (message: Uint8Array) => this.received(message),
      onMalformed: () => {
        ++this.numMalformed;
      },
      onClose: (why: string) => this.lost(why),
    };
    let opening: Transport | null = null;
    // A transport that was given up must not speak any more.
    const current = <A extends unknown[]>(run: (...args: A) => void) => (...args: A): void => {
      if (opening === null || opening === this.transport) run(...args);
    };
    opening = this.servers.opener.open({
      onOpen: current(events.onOpen),
      onMessage: current(events.onMessage),
      onMalformed: current(events.onMalformed),
      onClose: current(events.onClose),
    });
    this.transport = opening;
    this.schedule();
  }

  private opened(): void {
    this.heardMs = this.upMs = this.environment.nowMs();
    this.isUp = true;
    this.clock.reset();
    this.proveAgain();
    if (this.kind === 'udp') return;
    // A stream needs no proof. The daemon answers the Hello, which shows that it is one.
    this.isProven = true;
    this.reached();
    this.send(0, ping(this.nowUs()));
    for (const entry of this.entries) this.ask(entry);
  }

  private reached(): void {
    ++this.numConnects;
    this.failure = '';
    this.setState('open');
  }

  /** Says hello, and makes every request wait for an answer again. */
  private proveAgain(): void {
    this.isProven = false;
    this.token = 0n;
    for (const entry of this.entries) forget(entry);
    this.sayHello();
  }

  private sayHello(): void {
    this.send(0, hello(this.program, this.token, this.kind === 'udp', this.servers.opener.access ?? ''));
  }

  private letGo(): void {
    this.transport?.close();
    this.transport = null;
    this.isUp = this.isProven = false;
    this.serverSession = 0n;
    for (const entry of this.entries) forget(entry);
    this.cancelTimer();
  }

  private lost(why: string): void {
    if (this.isClosed) return;
    this.letGo();
    this.servers.next(this.environment.nowMs());
    if (why !== '') this.failure = why; // a daemon that wants a token has said so before it closed
    this.cancelTimer = this.environment.after(this.backoff.failed(), () => this.connect());
    this.setState('lost'); // last, because a listener may close the connection
  }

  private schedule(): void {
    this.cancelTimer();
    this.cancelTimer = this.environment.after(this.kind === 'udp' ? REPEAT_MS : PING_MS[this.kind], () => this.beat());
  }

  private beat(): void {
    this.schedule();
    const nowMs = this.environment.nowMs();
    if (!this.isUp) {
      if (nowMs - this.openedMs > (this.servers.opener.connectMs ?? CONNECT_MS)) this.lost('the daemon does not answer');
      return;
    }
    const silentMs = nowMs - this.heardMs;
    // A dead connection never completes a closing handshake, so it is given up. So is a daemon that does not answer the
    // Hello after a restart. Before the first answer, UDP keeps asking on the same socket.
    const isOpen = this.current === 'open' || this.current === 'draining';
    const mostMs = this.servers.hasOthers ? SILENCE_WITH_OTHERS_MS : SILENCE_MS;
    if (isOpen && silentMs > mostMs && this.environment.isAwake()) {
      this.lost('the daemon is silent');
      return;
    }
    const repeatMs = silentMs > SLOW_AFTER_MS ? SLOW_REPEAT_MS : REPEAT_MS;
    // Half of a period early, because timers are not exact.
    const isDue = (ms: number): boolean => nowMs - this.sentMs >= ms - REPEAT_MS / 2;
    if (!this.isProven) {
      if (isDue(repeatMs)) this.sayHello();
      return;
    }
    if (this.kind === 'udp') this.repeatRequests();
    if (isDue(PING_MS[this.kind])) this.send(0, ping(this.nowUs()));
  }

  private repeatRequests(): void {
    for (const entry of this.entries) {
      if (entry.waiting && entry.message !== null) this.transport?.send(entry.message);
    }
  }

  private send(stream: number, payload: Uint8Array): number {
    this.sequence = (this.sequence + 1) >>> 0;
    this.sentMs = this.environment.nowMs();
    this.transport?.send(writeMessage({ stream, session: this.session, sequence: this.sequence }, payload));
    return this.sequence;
  }

  private ask(entry: Entry): void {
    this.sequence = (this.sequence + 1) >>> 0;
    entry.stream = 0;
    entry.sequence = this.sequence;
    entry.requests = new Set([entry.sequence]);
    entry.message = writeMessage({ stream: 0, session: this.session, sequence: entry.sequence },
      entry.subscriber.request());
    entry.waiting = true;
    this.transport?.send(entry.message);
  }

  /** Returns the sequence of the message, or null if there is no stream to send it on. */
  private sendAbout(entry: Entry, payload: Uint8Array): number | null {
    if (!this.isProven || entry.stream === 0) return null;
    const sequence = this.send(entry.stream, payload);
    entry.requests.add(sequence);
    if (entry.requests.size > 64) entry.requests.delete(entry.requests.values().next().value!);
    return sequence;
  }

  private end(entry: Entry): void {
    this.sendAbout(entry, unsubscribe());
    this.entries.delete(entry);
  }

  private received(bytes: Uint8Array): void {
    try {
      this.handle(readMessage(bytes));
    } catch (error) {
      if (!(error instanceof Malformed)) throw error;
      ++this.numMalformed;
    }
  }

  private handle(message: Envelope): void {
    this.heardMs = this.environment.nowMs();
    if (this.heardMs - this.upMs >= PROVEN_MS) this.backoff.succeeded();
    this.noticeRestart(message.session);
    switch (message.identifier) {
      case 'FWEL':
        return this.welcomed(readWelcome(message.payload));
      case 'FPIN': // over UDP, a challenge: whether this address still wants what is sent to it
        this.send(0, pong(readPing(message.payload)));
        return;
      case 'FPON': {
        const answer = readPong(message.payload);
        this.clock.add(answer.timeUs, this.nowUs(), answer.serverTimeUs);
        return;
      }
      case 'FERR':
        return this.refused(message);
      case 'FSUR':
        return this.replied(message);
      case 'FBYE':
        return this.goodbye(message);
      default: {
        const entry = this.entryOf(message.stream);
        if (entry !== null && !entry.isFenced) entry.subscriber.onMessage(message);
      }
    }
  }

  /** Every message carries the daemon's session. Streams end with their daemon, so only UDP can meet another one. */
  private noticeRestart(session: bigint): void {
    const isOther = this.serverSession !== 0n && session !== this.serverSession;
    this.serverSession = session;
    if (isOther && this.isProven && this.kind === 'udp') this.proveAgain();
  }

  private welcomed({ token, others }: { token: bigint; others: string[] }): void {
    if (token === 0n) this.servers.remember(others);
    if (this.isProven) return;
    if (token !== 0n) {
      this.token = token;
      this.sayHello();
      return;
    }
    this.isProven = true;
    this.reached();
    for (const entry of this.entries) this.ask(entry);
  }

  private entryOf(stream: number): Entry | null {
    if (stream === 0) return null;
    for (const entry of this.entries) if (entry.stream === stream) return entry;
    return null;
  }

  private replied(message: Envelope): void {
    const reply = readReply(message.payload);
    for (const entry of this.entries) {
      if (entry.sequence !== message.sequence) continue;
      entry.stream = message.stream;
      entry.waiting = false;
      noteEpoch(entry, reply);
      if (entry.isFenced) return;
      entry.subscriber.onReply(reply, message.sequence);
      return;
    }
    // The subscription was ended before its reply arrived.
    this.send(message.stream, unsubscribe());
  }

  private refused(message: Envelope): void {
    const { code, message: text, elsewhere } = readError(message.payload);
    if (elsewhere !== null && code === ERROR.unknownSubject && this.follows(message.sequence, elsewhere)) return;
    if (code === ERROR.unproven && this.kind === 'udp') {
      if (this.isProven) this.proveAgain();
      return;
    }
    if (code === ERROR.draining) return; // the next daemon will be asked again
    if (code === ERROR.needsToken) {
      this.failure = text;
      for (const entry of this.entries) entry.subscriber.onRefused(code, this.failure, entry.sequence);
      return;
    }
    for (const entry of this.entries) {
      if (!entry.requests.delete(message.sequence)) continue;
      if (message.sequence === entry.sequence) entry.waiting = false;
      const web = this.isProven && elsewhere !== null && code === ERROR.unknownSubject ? webAddress(elsewhere) : null;
      if (web !== null && entry.subscriber.onElsewhere !== undefined) entry.subscriber.onElsewhere(web);
      else entry.subscriber.onRefused(code, text, message.sequence);
      return;
    }
  }

  /**
   * True if the connection goes on at another server, or asks here again later. One with several subjects cannot: they
   * may be at different servers. Only the answer to a request counts.
   */
  private follows(sequence: number, server: Server): boolean {
    const entries = [...this.entries];
    const subject = entries[0]?.subscriber.asksFor?.();
    const isAsked = entries.some((entry) => entry.sequence === sequence);
    const isOne = subject !== undefined && entries.every(({ subscriber }) => subscriber.asksFor?.() === subject);
    if (!this.servers.canFollow(server) || !this.isProven || !isAsked || !isOne) return false;
    if (this.servers.goTo(server, this.environment.nowMs())) {
      this.letGo();
      this.connect();
      return true;
    }
    for (const entry of entries) {
      forget(entry);
      this.environment.after(STAY_MS, () => {
        if (this.isProven && this.entries.has(entry) && entry.message === null) this.ask(entry);
      });
    }
    return true;
  }

  private goodbye(message: Envelope): void {
    const reason = readGoodbye(message.payload);
    if (reason === TIMED_OUT) {
      // A goodbye that was delayed may concern a subscription that has been made again since.
      if (this.kind === 'udp' && this.entryOf(message.stream) !== null) this.proveAgain();
    } else if (message.stream === 0) {
      if (reason === DRAINING) this.setState('draining');
    } else {
      const entry = this.entryOf(message.stream);
      if (reason === SUBJECT_GONE) entry?.subscriber.onGone();
      if (reason === DONE) entry?.subscriber.onRefused(0, 'the daemon has ended the subscription', entry.sequence);
    }
  }
}

/** Epochs of different subjects do not compare. A reply without one says that the request waits. */
function noteEpoch(entry: Entry, reply: ReplyMessage): void {
  if (reply.subject !== '' && reply.subject !== entry.served) {
    entry.served = reply.subject;
    entry.epoch = 0n;
  }
  entry.isFenced = reply.epoch !== 0n && reply.epoch < entry.epoch;
  if (reply.epoch > entry.epoch) entry.epoch = reply.epoch;
}

function forget(entry: Entry): void {
  entry.stream = 0;
  entry.sequence = 0;
  entry.waiting = false;
  entry.message = null;
  entry.requests.clear();
}

/** A random number of 64 bits that is not 0. */
function randomSession(random: () => number): bigint {
  const word = (): bigint => BigInt(Math.floor(random() * 2 ** 32));
  return ((word() << 32n) | word()) || 1n;
}

/** The beginning of a text, at most `most` bytes of UTF-8. */
function cut(text: string, most: number): string {
  let end = text.length;
  while (new TextEncoder().encode(text.slice(0, end)).length > most) --end;
  return text.slice(0, end);
}
