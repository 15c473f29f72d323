// SPDX-License-Identifier: Apache-2.0
// When to try again. The pause doubles with each failure in a row, up to a limit with which a client is back within
// one second of the daemon. A random part keeps the clients of a restarted daemon from coming back in one instant.

const FIRST_MS = 50;
const MOST_MS = 800;

export class Backoff {
  private pauseMs = FIRST_MS;

  /** `random`: a number in [0, 1), as Math.random(). */
  constructor(private readonly random: () => number) {}

  /** An attempt failed, or a connection was lost: milliseconds until the next attempt. */
  failed(): number {
    const pauseMs = this.pauseMs * (0.5 + 0.5 * this.random());
    this.pauseMs = Math.min(2 * this.pauseMs, MOST_MS);
    return pauseMs;
  }

  /** The connection works, so the next pause is short again. */
  succeeded(): void {
    this.pauseMs = FIRST_MS;
  }
}
