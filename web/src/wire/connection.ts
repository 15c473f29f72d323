// SPDX-License-Identifier: Apache-2.0
// One WebSocket to the daemon for all subscriptions of the page. It reconnects and subscribes again
// by itself.
import { Signal } from '../ui/signal';
import { nowUs, ServerClock } from './clock';
import { type Envelope, readMessage, writeMessage } from './envelope';
import { ping, readError, readGoodbye, readPong, readReply, type ReplyMessage } from './messages';

const PING_MS = 1000;
/** The connection counts as lost after this time without a message. Pongs arrive every second. */
const SILENCE_MS = 5000;

/** The request of a subscription and its callbacks. */
export interface Subscriber {
  /** Returns the current request. Called for every connection. */
  request(): Uint8Array;
  onReply(reply: ReplyMessage, requestSequence: number): void;
  onMessage(message: Envelope): void;
  /** The subject left. The subscription waits for it. */
  onGone(): void;
  /** `sequence`: that of the rejected request. */
  onRefused(code: number, message: string, sequence: number): void;
}

export type LinkState = 'connecting' | 'open' | 'lost' | 'draining';

/** Milliseconds before attempt `attempt` (from 0): 100 ms, then growing up to 4 s. */
export function retryDelayMs(attempt: number): number {
  return attempt === 0 ? 100 : Math.min(4000, 250 * 2 ** Math.min(attempt - 1, 8));
}

/** A random number of 63 bits that is not 0. */
function randomSession(): bigint {
  const words = crypto.getRandomValues(new Uint32Array(2));
  return ((BigInt(words[0]! & 0x7fffffff) << 32n) | BigInt(words[1]!)) || 1n;
}

interface Entry {
  subscriber: Subscriber;
  /** Sequence of the subscribing request, which the reply repeats. */
  sequence: number;
  /** 0 until the daemon has replied. */
  stream: number;
  /** Sequences of requests about the subscription, to assign errors to it. */
  requests: Set<number>;
}

export class Connection {
  readonly state = new Signal<LinkState>('connecting');
  readonly clock = new ServerClock();
  private socket: WebSocket | null = null;
  private readonly session = randomSession();
  private sequence = 0;
  private attempt = 0;
  private heardMs = 0;
  private readonly entries = new Set<Entry>();

  constructor(private readonly url: string) {
    setInterval(() => this.beat(), PING_MS);
    this.connect();
  }

  /** Sends the request now if the connection is open, otherwise once it is. */
  subscribe(subscriber: Subscriber): Subscription {
    const entry: Entry = { subscriber, sequence: 0, stream: 0, requests: new Set() };
    this.entries.add(entry);
    if (this.isOpen()) this.ask(entry);
    return {
      send: (payload) => this.sendAbout(entry, payload),
      close: (farewell) => {
        if (entry.stream !== 0 && this.isOpen()) this.send(entry.stream, farewell);
        this.entries.delete(entry);
      },
      askAgain: () => {
        if (this.isOpen()) this.ask(entry);
      },
    };
  }

  private isOpen(): boolean {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  private connect(): void {
    const socket = new WebSocket(this.url, 'furrow.1');
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    socket.onopen = () => this.opened();
    socket.onmessage = (event: MessageEvent<ArrayBuffer>) => this.received(event.data);
    socket.onclose = () => this.closed(socket);
  }

  private opened(): void {
    this.attempt = 0;
    this.heardMs = performance.now();
    this.clock.reset();
    this.state.set('open');
    this.send(0, ping(nowUs()));
    for (const entry of this.entries) this.ask(entry);
  }

  private closed(socket: WebSocket): void {
    if (socket !== this.socket) return;
    this.socket = null;
    for (const entry of this.entries) {
      entry.stream = 0;
      entry.requests.clear();
    }
    this.state.set('lost');
    setTimeout(() => this.connect(), retryDelayMs(this.attempt++));
  }

  private beat(): void {
    if (!this.isOpen()) return;
    if (performance.now() - this.heardMs > SILENCE_MS && document.visibilityState === 'visible') {
      const socket = this.socket!;
      socket.close();
      this.closed(socket); // a dead connection never completes the closing handshake
      return;
    }
    this.send(0, ping(nowUs()));
  }

  private send(stream: number, payload: Uint8Array): number {
    this.sequence = (this.sequence + 1) >>> 0;
    const to = { stream, session: this.session, sequence: this.sequence };
    this.socket!.send(writeMessage(to, payload));
    return this.sequence;
  }

  private ask(entry: Entry): void {
    entry.stream = 0;
    entry.sequence = this.send(0, entry.subscriber.request());
    entry.requests = new Set([entry.sequence]);
  }

  /** Returns the sequence of the request, or null if there is no stream to send it on. */
  private sendAbout(entry: Entry, payload: Uint8Array): number | null {
    if (!this.isOpen() || entry.stream === 0) return null;
    const sequence = this.send(entry.stream, payload);
    entry.requests.add(sequence);
    if (entry.requests.size > 64) entry.requests.delete(entry.requests.values().next().value!);
    return sequence;
  }

  private received(data: ArrayBuffer): void {
    this.heardMs = performance.now();
    const message = readMessage(data);
    if (message === null) return;
    switch (message.identifier) {
      case 'FPON': {
        const pong = readPong(message.payload);
        this.clock.add(pong.timeUs, nowUs(), pong.serverTimeUs);
        return;
      }
      case 'FERR':
        return this.refused(message);
      case 'FSUR':
        return this.replied(message);
      case 'FBYE':
        return this.goodbye(message);
      default:
        this.entryOf(message.stream)?.subscriber.onMessage(message);
    }
  }

  private entryOf(stream: number): Entry | null {
    if (stream === 0) return null;
    for (const entry of this.entries) if (entry.stream === stream) return entry;
    return null;
  }

  private replied(message: Envelope): void {
    for (const entry of this.entries) {
      if (entry.sequence !== message.sequence) continue;
      entry.stream = message.stream;
      entry.subscriber.onReply(readReply(message.payload), message.sequence);
      return;
    }
  }

  private refused(message: Envelope): void {
    const { code, message: text } = readError(message.payload);
    for (const entry of this.entries) {
      if (!entry.requests.delete(message.sequence)) continue;
      entry.subscriber.onRefused(code, text, message.sequence);
      return;
    }
  }

  private goodbye(message: Envelope): void {
    if (message.stream === 0) {
      if (readGoodbye(message.payload) === 2) this.state.set('draining');
      return;
    }
    this.entryOf(message.stream)?.subscriber.onGone();
  }
}

/** Handle of a subscription made by Connection.subscribe(). */
export interface Subscription {
  /** Sends a message on the subscription's stream. Returns its sequence, or null if it was not sent. */
  send(payload: Uint8Array): number | null;
  close(farewell: Uint8Array): void;
  /** Subscribes again, for example after a rejection. */
  askAgain(): void;
}
