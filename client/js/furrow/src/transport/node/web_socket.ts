// SPDX-License-Identifier: Apache-2.0
// A WebSocket client (RFC 6455) for Node, which has none before version 22. Messages are binary; there are no
// extensions.
import { createHash, randomBytes } from 'node:crypto';
import type { Socket } from 'node:net';
import { webAddress } from '../../link/servers.js';
import { MAX_REPLY_BYTES } from '../../wire/envelope.js';
import { MAX_UNSENT_BYTES, TLS_CONNECT_MS, type Transport, type TransportEvents, type TransportOpener } from '../transport.js';
import { offeredProtocols } from '../web_socket.js';
import { ByteQueue } from './byte_queue.js';
import { connectStream, mayShowTokenElsewhere, NO_SECURITY, type StreamSecurity } from './stream.js';

const GUID = '258EAFA5-E914-47DA-95CA-C5AB0DC85B11';
const MAX_HEAD_BYTES = 8192;
const OPCODE = { continuation: 0, text: 1, binary: 2, close: 8, ping: 9, pong: 10 } as const;
const MAX_CONTROL_BYTES = 125;
/** Frames of one message. Empty ones would otherwise take memory without end. */
const MAX_PARTS = 4096;

export function nodeWebSocket(host: string, port: number, security = NO_SECURITY, path = '/ws'): TransportOpener {
  const opener: TransportOpener = { kind: 'ws', open: (events) => new NodeWebSocket(host, port, security, path, events) };
  if (security.tls !== null) opener.connectMs = TLS_CONNECT_MS;
  if (!mayShowTokenElsewhere(security)) return opener;
  opener.elsewhere = (server) => {
    const reaches = webAddress(server) !== null && server.isWebTls === (security.tls !== null);
    return reaches ? nodeWebSocket(server.host, server.web, security) : null;
  };
  return opener;
}

class NodeWebSocket implements Transport {
  private readonly socket: Socket;
  private readonly queue = new ByteQueue();
  private readonly key = randomBytes(16).toString('base64');
  private head: string | null = '';
  private parts: Uint8Array[] = [];
  private numBytes = 0;
  private why = '';
  private isStopped = false;
  private isClosed = false;

  constructor(host: string, port: number, security: StreamSecurity, path: string, private readonly events: TransportEvents) {
    const name = host.includes(':') ? `[${host}]` : host;
    const ask = (): void => void this.socket.write(
      `GET ${path} HTTP/1.1\r\nHost: ${name}:${port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n` +
      `Sec-WebSocket-Key: ${this.key}\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: ${offeredProtocols(security.token).join(', ')}\r\n\r\n`);
    this.socket = connectStream(host, port, security, 'http/1.1', ask, (why) => this.giveUp(why));
    this.socket.on('data', (chunk) => this.received(chunk));
    this.socket.on('close', () => {
      if (!this.isClosed) events.onClose(this.why);
    });
  }

  private giveUp(why: string): void {
    this.why = why;
    this.socket.destroy();
    this.isStopped = true;
  }

  private received(chunk: Buffer): void {
    let rest: Uint8Array = chunk;
    if (this.head !== null) {
      this.head += chunk.toString('latin1');
      const end = this.head.indexOf('\r\n\r\n');
      if (end < 0) {
        if (this.head.length > MAX_HEAD_BYTES) this.giveUp('the reply is too long');
        return;
      }
      rest = Buffer.from(this.head.slice(end + 4), 'latin1');
      if (!this.isUpgrade(this.head.slice(0, end))) return;
      this.head = null;
      this.events.onOpen();
    }
    this.queue.push(rest);
    while (!this.isClosed && !this.isStopped && this.readFrame());
  }

  private isUpgrade(head: string): boolean {
    const [status = '', ...lines] = head.split('\r\n');
    const accept = lines.map((line) => /^sec-websocket-accept:\s*(\S+)\s*$/i.exec(line)?.[1]).find(Boolean);
    const expected = createHash('sha1').update(this.key + GUID).digest('base64');
    if (/^HTTP\/1\.1 101\b/.test(status) && accept === expected) return true;
    if (/^HTTP\/1\.1 401\b/.test(status)) {
      this.giveUp('the daemon requires a token, or refuses the one that it was shown');
      return false;
    }
    this.giveUp(`no WebSocket: ${status.slice(0, 80).replace(/[^ -~]/g, '?')}`);
    return false;
  }

  /** True if a whole frame was there. */
  private readFrame(): boolean {
    let head = this.queue.peek(2);
    if (head === null) return false;
    const short = head[1]! & 0x7f;
    const headBytes = short === 126 ? 4 : short === 127 ? 10 : 2;
    head = this.queue.peek(headBytes);
    if (head === null) return false;
    const view = new DataView(head.buffer, head.byteOffset, headBytes);
    const size = short === 126 ? view.getUint16(2) : short === 127 ? Number(view.getBigUint64(2)) : short;
    const opcode = head[0]! & 0x0f;
    const isControl = opcode >= OPCODE.close;
    // Frames of a server have no mask (section 5.1), and without extensions no reserved bits.
    if ((head[1]! & 0x80) !== 0 || (head[0]! & 0x70) !== 0 || this.numBytes + size > MAX_REPLY_BYTES ||
        this.parts.length >= MAX_PARTS || (isControl && size > MAX_CONTROL_BYTES)) {
      this.events.onMalformed();
      this.giveUp('the daemon sent an invalid frame');
      return false;
    }
    const isFinal = (head[0]! & 0x80) !== 0;
    const frame = this.queue.take(headBytes + size);
    if (frame === null) return false;
    this.onFrame(opcode, isFinal, frame.subarray(headBytes));
    return true;
  }

  private onFrame(opcode: number, isFinal: boolean, payload: Uint8Array): void {
    if (opcode === OPCODE.ping) this.write(OPCODE.pong, payload);
    if (opcode === OPCODE.close) {
      this.write(OPCODE.close, payload.subarray(0, 2));
      this.giveUp('the daemon closed the connection');
    }
    if (opcode === OPCODE.text) this.events.onMalformed();
    if (opcode !== OPCODE.binary && opcode !== OPCODE.continuation) return;
    this.parts.push(payload);
    this.numBytes += payload.length;
    if (!isFinal) return;
    const message = this.parts.length === 1 ? payload : new Uint8Array(Buffer.concat(this.parts));
    this.parts = [];
    this.numBytes = 0;
    this.events.onMessage(message);
  }

  send(message: Uint8Array<ArrayBuffer>): void {
    if (this.head !== null || this.isClosed) return;
    if (this.socket.writableLength > MAX_UNSENT_BYTES) this.giveUp('the daemon does not read');
    else this.write(OPCODE.binary, message);
  }

  private write(opcode: number, payload: Uint8Array): void {
    const long = payload.length > 65_535 ? 8 : payload.length > 125 ? 2 : 0;
    const frame = Buffer.alloc(2 + long + 4 + payload.length);
    frame[0] = 0x80 | opcode;
    frame[1] = 0x80 | (long === 8 ? 127 : long === 2 ? 126 : payload.length);
    if (long === 2) frame.writeUInt16BE(payload.length, 2);
    if (long === 8) frame.writeBigUInt64BE(BigInt(payload.length), 2);
    const mask = randomBytes(4);
    frame.set(mask, 2 + long);
    for (let i = 0; i < payload.length; ++i) frame[6 + long + i] = payload[i]! ^ mask[i & 3]!;
    this.socket.write(frame);
  }

  close(): void {
    if (this.isClosed) return;
    if (this.head === null) this.write(OPCODE.close, Uint8Array.of(0x03, 0xe8)); // 1000: done
    this.isClosed = true;
    // The last messages are still to be sent. A socket that is not connected has none, and would wait for minutes.
    if (this.socket.connecting) this.socket.destroy();
    else this.socket.destroySoon();
  }
}
