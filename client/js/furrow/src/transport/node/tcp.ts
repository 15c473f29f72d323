// SPDX-License-Identifier: Apache-2.0
// TCP: each message follows its length (protocol/STANDARD.md section 1).
import { ENVELOPE_BYTES, MAX_REPLY_BYTES } from '../../wire/envelope.js';
import { MAX_UNSENT_BYTES, TLS_CONNECT_MS, type Transport, type TransportEvents, type TransportOpener } from '../transport.js';
import { ByteQueue } from './byte_queue.js';
import { connectStream, mayShowTokenElsewhere, NO_SECURITY, type StreamSecurity } from './stream.js';

export function tcpSocket(host: string, port: number, security = NO_SECURITY): TransportOpener {
  const opener: TransportOpener = {
    kind: 'tcp', access: security.token, open: (events) => openTcp(host, port, security, events),
  };
  if (security.tls !== null) opener.connectMs = TLS_CONNECT_MS;
  if (mayShowTokenElsewhere(security)) opener.elsewhere = (server) => tcpSocket(server.host, server.tcp, security);
  return opener;
}

function openTcp(host: string, port: number, security: StreamSecurity, events: TransportEvents): Transport {
  const queue = new ByteQueue();
  let why = '';
  let isClosed = false;
  let isOpen = false;
  const giveUp = (reason: string): void => {
    why = reason;
    socket.destroy();
  };
  const opened = (): void => {
    isOpen = true;
    events.onOpen();
  };
  const socket = connectStream(host, port, security, 'furrow/1', opened, giveUp);
  socket.on('data', (chunk) => {
    queue.push(chunk);
    while (!isClosed) {
      const head = queue.peek(4);
      if (head === null) return;
      const size = new DataView(head.buffer, head.byteOffset).getUint32(0, true);
      if (size < ENVELOPE_BYTES || size > MAX_REPLY_BYTES) {
        events.onMalformed();
        giveUp('the daemon sent a frame of an invalid length');
        return;
      }
      const frame = queue.take(4 + size);
      if (frame === null) return;
      events.onMessage(frame.subarray(4));
    }
  });
  socket.on('close', () => {
    if (!isClosed) events.onClose(why);
  });
  return {
    send: (message) => {
      if (!isOpen || socket.readyState !== 'open') return;
      if (socket.writableLength > MAX_UNSENT_BYTES) {
        giveUp('the daemon does not read');
        return;
      }
      const length = new Uint8Array(4);
      new DataView(length.buffer).setUint32(0, message.length, true);
      socket.cork();
      socket.write(length);
      socket.write(message);
      socket.uncork();
    },
    close: () => {
      isClosed = true;
      // The last messages are still to be sent. A socket that is not connected has none, and would wait for minutes.
      if (!isOpen) socket.destroy();
      else socket.destroySoon();
    },
  };
}
