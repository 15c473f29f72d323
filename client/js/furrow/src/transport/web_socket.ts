// SPDX-License-Identifier: Apache-2.0
// The browser's WebSocket.
import { webAddress } from '../link/servers.js';
import { MAX_UNSENT_BYTES, TLS_CONNECT_MS, type Transport, type TransportEvents, type TransportOpener } from './transport.js';

export const WEB_SOCKET_PROTOCOL = 'furrow.1';

/** What a client offers. A browser can set no header, so a connect token travels as a protocol that nobody chooses. */
export function offeredProtocols(token: string): string[] {
  return token === '' ? [WEB_SOCKET_PROTOCOL] : [WEB_SOCKET_PROTOCOL, token];
}

/**
 * `token`: returns the text of a connect token, or an empty text; asked at each attempt. With a token, the client stays
 * at its server: a browser would show it to any server with a certificate.
 */
export function browserSocket(url: string, token: () => string = () => ''): TransportOpener {
  return {
    kind: 'ws',
    ...(url.startsWith('wss:') ? { connectMs: TLS_CONNECT_MS } : {}),
    open: (events) => openSocket(url, token(), events),
    elsewhere: (server) => {
      const web = webAddress(server);
      const isWeaker = url.startsWith('wss:') && !server.isWebTls;
      return web === null || isWeaker || token() !== '' ? null : browserSocket(`${web.replace(/^http/, 'ws')}/ws`, token);
    },
  };
}

function openSocket(url: string, token: string, events: TransportEvents): Transport {
  const socket = new WebSocket(url, offeredProtocols(token));
  socket.binaryType = 'arraybuffer';
  socket.onopen = () => events.onOpen();
  socket.onmessage = ({ data }: MessageEvent<unknown>) => {
    if (data instanceof ArrayBuffer) events.onMessage(new Uint8Array(data));
    else events.onMalformed();
  };
  socket.onclose = ({ reason }) => events.onClose(reason);
  const close = (): void => {
    socket.onclose = null;
    socket.onmessage = null;
    socket.close();
  };
  return {
    send: (message) => {
      if (socket.readyState !== WebSocket.OPEN) return;
      if (socket.bufferedAmount <= MAX_UNSENT_BYTES) {
        socket.send(message);
        return;
      }
      close();
      queueMicrotask(() => events.onClose('the daemon does not read'));
    },
    close,
  };
}
