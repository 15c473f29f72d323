// SPDX-License-Identifier: Apache-2.0

export type TransportKind = 'ws' | 'tcp' | 'udp';

/** What happens to a transport. After onClose() nothing follows. */
export interface TransportEvents {
  onOpen(): void;
  /** One whole message, which the receiver may keep. */
  onMessage(message: Uint8Array): void;
  /** Bytes that are not a message were dropped. */
  onMalformed(): void;
  /** `why`: one sentence, or empty. */
  onClose(why: string): void;
}

/** A connection with more unsent bytes is given up, because its peer does not read. All requests of a client are fewer. */
export const MAX_UNSENT_BYTES = 1 << 22;

/**
 * The time for a connect with a TLS handshake. A daemon gives a client 5 seconds to find its turn among the clients of
 * its host, and then closes the connection.
 */
export const TLS_CONNECT_MS = 7000;

/** One connection that carries whole messages. It opens at once and never opens again. */
export interface Transport {
  /** Sends a message, or drops it if there is no connection. */
  send(message: Uint8Array<ArrayBuffer>): void;
  /** Closes without onClose(). */
  close(): void;
}

/** How clients reach another server of the daemon's cluster. */
export interface Server {
  /** A name or a numeric address, without brackets. */
  host: string;
  tcp: number;
  udp: number;
  /** The port of its web server; 0: it has none, or nobody has said so. */
  web: number;
  /** The web server speaks HTTPS, not HTTP. */
  isWebTls: boolean;
}

/** Starts one attempt. */
export interface TransportOpener {
  kind: TransportKind;
  /**
   * A random number of 64 bits for the session. UDP needs one that nobody can guess: it is what tells the messages of
   * this client from forged ones (protocol/STANDARD.md section 4).
   */
  makeSession?(): bigint;
  /** An attempt that takes longer has failed, milliseconds. Absent: 3 seconds. */
  connectMs?: number;
  /** The text of the connect token that each Hello shows; absent or empty: none. */
  access?: string;
  /**
   * The same for a server that the daemon has named. Null if this kind of transport does not reach it. Absent if the
   * client must not follow: the token would be shown to a server that nobody has proved to be one of them.
   */
  elsewhere?(server: Server): TransportOpener | null;
  open(events: TransportEvents): Transport;
}
