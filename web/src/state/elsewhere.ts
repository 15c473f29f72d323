// SPDX-License-Identifier: Apache-2.0
// The way of the page to the daemon that serves its subject.
import { text } from '../text';

/** Daemons may contradict each other for a moment, so the page takes its time. */
const PAUSE_MS = 1000;
/** If they contradict each other for longer, the page stays somewhere. */
const MOST_MOVES = 4;
/** The number of moves is in the fragment, because the page of each daemon has a storage of its own. */
const MOVES = 'moves';

export interface ElsewhereParts {
  /** The address of the present state of the page. */
  link(): string;
  go(url: string): void;
  say(words: string, kind?: 'info' | 'error'): void;
}

export class Elsewhere {
  private moves: number;
  private timer: ReturnType<typeof setTimeout> | null = null;

  /** `hash`: of the page's URL. */
  constructor(hash: string, private readonly parts: ElsewhereParts) {
    const moves = new URLSearchParams(hash.replace(/^#/, '')).get(MOVES) ?? '';
    this.moves = /^\d{1,4}$/.test(moves) ? Number(moves) : 0;
  }

  /**
   * Goes soon to the page at `web`, "https://host:7480", with the same settings, which the fragment holds. That page asks
   * for a token if it needs one. Never goes from HTTPS to HTTP.
   */
  follow(web: string): void {
    this.stop();
    const { parts, moves } = this;
    if (new URL(parts.link()).protocol === 'https:' && !web.startsWith('https:')) {
      parts.say(text.app.elsewhereInsecure(web), 'error');
    } else if (moves >= MOST_MOVES) {
      parts.say(text.app.elsewhereAgain(web), 'error');
    } else {
      parts.say(text.app.elsewhere(new URL(web).host));
      this.timer = setTimeout(() => parts.go(this.pageAt(web)), PAUSE_MS);
    }
  }

  /** The user chose another subject, or this daemon serves the subject: the page stays, and earlier moves do not count. */
  reset(): void {
    this.stop();
    this.moves = 0;
  }

  private stop(): void {
    if (this.timer !== null) clearTimeout(this.timer);
    this.timer = null;
  }

  private pageAt(web: string): string {
    const { pathname, hash } = new URL(this.parts.link());
    const parameters = new URLSearchParams(hash.replace(/^#/, ''));
    parameters.set(MOVES, String(this.moves + 1));
    return `${web}${pathname}#${parameters}`;
  }
}
