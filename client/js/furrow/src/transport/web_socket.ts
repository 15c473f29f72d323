// SPDX-License-Identifier: Apache-2.0
// The browser's WebSocket.
import type { Transport, TransportEvents, TransportOpener } from './transport.js';

export const WEB_SOCKET_PROTOCOL = 'furrow.1';

export function browserSocket(url: string): TransportOpener {
  return { kind: 'ws', open: (events) => openSocket(url, events) };
}

function openSocket(url: string, events: TransportEvents): Transport {
  const socket = new WebSocket(url, WEB_SOCKET_PROTOCOL);
  socket.binaryType = 'arraybuffer';
  socket.onopen = () => events.onOpen();
  socket.onmessage = ({ data }: MessageEvent<unknown>) => {
    if (data instanceof ArrayBuffer) events.onMessage(new Uint8Array(data));
    else events.onMalformed();
  };
  socket.onclose = ({ reason }) => events.onClose(reason);
  return {
    send: (message) => {
      if (socket.readyState === WebSocket.OPEN) socket.send(message);
    },
    close: () => {
      socket.onclose = null;
      socket.onmessage = null;
      socket.close();
    },
  };
}
