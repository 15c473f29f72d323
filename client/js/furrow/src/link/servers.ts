// SPDX-License-Identifier: Apache-2.0
// The servers of the daemon's cluster, and where the connection goes next (protocol/STANDARD.md section 10).
import type { Server, TransportOpener } from '../transport/transport.js';

/** Servers may contradict each other for a moment, so a client follows at most so often in so long. */
const MOST_MOVES = 4;
const MOVE_WINDOW_MS = 10_000;
/** No daemon can send the client back to a server that was lost this short a time ago. */
const LOST_MS = 3000;
const MOST_SERVERS = 8;

const isSame = (a: Server | null, b: Server | null): boolean =>
  a === b || (a !== null && b !== null && a.host === b.host && a.tcp === b.tcp && a.udp === b.udp);

/** "HOST:TCP:UDP", as in Welcome; null if it is not. */
export function parseServer(text: string): Server | null {
  const found = /^(.+):(\d{1,5}):(\d{1,5})$/.exec(text);
  const [tcp, udp] = [Number(found?.[2]), Number(found?.[3])];
  const isPort = (port: number): boolean => port >= 1 && port <= 65535;
  return found !== null && isPort(tcp) && isPort(udp) ? { host: found[1]!, tcp, udp, web: 0, isWebTls: false } : null;
}

/** The address of the server's web server, "https://host:7480"; null if there is none, or if it is not an address. */
export function webAddress({ host, web, isWebTls }: Server): string | null {
  if (web === 0 || !/^[\w.:-]+$/.test(host)) return null;
  return `${isWebTls ? 'https' : 'http'}://${host.includes(':') ? `[${host}]` : host}:${web}`;
}

export class Servers {
  /** Null: the first one, which the address names. */
  private all: (Server | null)[] = [null];
  private present = 0;
  private moves: number[] = [];
  private lost: { server: Server | null; ms: number } | null = null;

  constructor(private readonly first: TransportOpener) {}

  /** False: the client must not show its token to the server, or this transport cannot reach it. */
  canFollow(server: Server): boolean {
    return (this.first.elsewhere?.(server) ?? null) !== null;
  }

  get hasOthers(): boolean {
    return this.all.length > 1;
  }

  /** Opens connections to the present server. */
  get opener(): TransportOpener {
    const server = this.all[this.present]!;
    return (server === null ? null : this.first.elsewhere?.(server)) ?? this.first;
  }

  /** The daemon sends the client to a server. False: it stays for now, and should ask again later. */
  goTo(server: Server, nowMs: number): boolean {
    this.moves = this.moves.filter((at) => nowMs - at <= MOVE_WINDOW_MS);
    const isLost = this.lost !== null && isSame(this.lost.server, server) && nowMs - this.lost.ms < LOST_MS;
    if (isLost || this.moves.length >= MOST_MOVES) return false;
    this.moves.push(nowMs);
    let found = this.all.findIndex((known) => known !== null && isSame(known, server));
    if (found < 0) {
      if (this.all.length > MOST_SERVERS) this.all.pop();
      found = this.all.push(server) - 1;
    }
    this.present = found;
    return true;
  }

  /** The present server is lost: the next one is tried. */
  next(nowMs: number): void {
    this.lost = { server: this.all[this.present]!, ms: nowMs };
    this.present = (this.present + 1) % this.all.length;
  }

  /** The servers of a Welcome. */
  remember(texts: readonly string[]): void {
    const present = this.all[this.present]!;
    const others = texts.slice(0, MOST_SERVERS).map(parseServer)
      .filter((server) => server !== null && !isSame(server, present) && this.canFollow(server));
    this.all = [null, ...others];
    this.present = present === null ? 0 : this.all.push(present) - 1;
  }
}
