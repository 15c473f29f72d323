// SPDX-License-Identifier: Apache-2.0
// UDP: one message, several, or a fragment of one per datagram (protocol/STANDARD.md section 3).
import { randomBytes } from 'node:crypto';
import { createSocket } from 'node:dgram';
import { lookup } from 'node:dns';
import { Datagrams, splitMessage } from '../../wire/datagrams.js';
import { Malformed } from '../../wire/flat_table.js';
import type { Transport, TransportEvents, TransportOpener } from '../transport.js';

const RECEIVE_BYTES = 1 << 20;

export function udpSocket(host: string, port: number): TransportOpener {
  return {
    kind: 'udp',
    makeSession: () => randomBytes(8).readBigUInt64LE(),
    open: (events) => new UdpSocket(host, port, events),
  };
}

class UdpSocket implements Transport {
  private socket: ReturnType<typeof createSocket> | null = null;
  private readonly datagrams = new Datagrams();
  private messageId = 0;
  private isConnected = false;
  private isClosed = false;

  constructor(host: string, port: number, private readonly events: TransportEvents) {
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
      this.events.onOpen();
    });
    socket.connect(port, address); // so that the system drops datagrams from other addresses
  }

  private received(datagram: Uint8Array): void {
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
      // A refused send is reported here, not as an event of the socket.
      this.socket!.send(datagram, (error) => error && this.fail(error.message));
    }
  }

  close(): void {
    if (this.isClosed) return;
    this.isClosed = true;
    const { socket } = this;
    // The last datagrams are still to be sent; close() would drop them.
    if (socket !== null) setImmediate(() => socket.close());
  }
}
