// SPDX-License-Identifier: Apache-2.0
// UDP: one message, several, or a fragment of one per datagram (protocol/STANDARD.md section 3).
import { randomBytes } from 'node:crypto';
import { createSocket } from 'node:dgram';
import { lookup } from 'node:dns';
import { Datagrams, splitMessage } from '../../wire/datagrams.js';
import { Malformed } from '../../wire/flat_table.js';
import type { Transport, TransportEvents, TransportOpener } from '../transport.js';
import { SecureSession } from './secure/session.js';
import { parseToken, type Token } from './secure/token.js';

const RECEIVE_BYTES = 1 << 20;

/** `token`: the text of a connect token, with which everything is sealed; empty: plain. */
export function udpSocket(host: string, port: number, token = ''): TransportOpener {
  const parsed = token === '' ? null : parseToken(token);
  return {
    kind: 'udp',
    makeSession: () => randomBytes(8).readBigUInt64LE(),
    // The other server must know the key of the token, and learns nothing.
    elsewhere: (server) => udpSocket(server.host, server.udp, token),
    open: (events) => new UdpSocket(host, port, parsed, events),
  };
}

const TICK_MS = 50;

class UdpSocket implements Transport {
  private socket: ReturnType<typeof createSocket> | null = null;
  private readonly datagrams = new Datagrams();
  private messageId = 0;
  private isConnected = false;
  private isClosed = false;
  private readonly secure: SecureSession | null;
  private timer: ReturnType<typeof setInterval> | null = null;

  constructor(host: string, port: number, token: Token | null, private readonly events: TransportEvents) {
    this.secure = token && new SecureSession(token, {
      send: (packet) => this.write(packet),
      onBegin: () => events.onOpen(),
      onDatagram: (datagram) => this.accept(datagram),
      onEnd: (why) => this.fail(why),
    });
    lookup(host, (error, address, family) => {
      if (this.isClosed) return;
      if (error) this.fail(error.message);
      else this.open(address, family === 6 ? 'udp6' : 'udp4', port);
    });
  }

  private open(address: string, type: 'udp4' | 'udp6', port: number): void {
    const socket = createSocket({ type, recvBufferSize: RECEIVE_BYTES });
    this.socket = socket;
    socket.on('message', (datagram) => this.received(datagram));
    // A closed port: the daemon is away.
    socket.on('error', (error) => this.fail(error.message));
    socket.on('connect', () => {
      this.isConnected = true;
      if (this.secure === null) return this.events.onOpen();
      this.timer = setInterval(() => this.secure!.tick(performance.now()), TICK_MS);
      this.secure.tick(performance.now());
    });
    socket.connect(port, address); // so that the system drops datagrams from other addresses
  }

  private received(datagram: Uint8Array): void {
    if (this.secure === null) this.accept(datagram);
    else if (!this.isClosed) this.secure.received(datagram, performance.now()); // nothing proves a plain answer
  }

  private accept(datagram: Uint8Array): void {
    let messages: Uint8Array[];
    try {
      messages = this.datagrams.accept(datagram, performance.now());
    } catch (error) {
      if (!(error instanceof Malformed)) throw error;
      this.events.onMalformed();
      return;
    }
    for (const message of messages) {
      if (!this.isClosed) this.events.onMessage(message);
    }
  }

  private fail(why: string): void {
    if (this.isClosed) return;
    this.close();
    this.events.onClose(why);
  }

  send(message: Uint8Array<ArrayBuffer>): void {
    if (!this.isConnected || this.isClosed) return;
    for (const datagram of splitMessage(message, this.messageId++ >>> 0)) {
      if (this.secure === null) this.write(datagram);
      else this.secure.send(datagram, performance.now());
    }
  }

  private write(datagram: Uint8Array): void {
    // A refused send is reported here, not as an event of the socket.
    this.socket!.send(datagram, (error) => error && this.fail(error.message));
  }

  close(): void {
    if (this.isClosed) return;
    if (this.isConnected) this.secure?.close(performance.now());
    if (this.timer !== null) clearInterval(this.timer);
    this.isClosed = true;
    const { socket } = this;
    // The last datagrams are still to be sent; close() would drop them.
    if (socket !== null) setImmediate(() => socket.close());
  }
}
