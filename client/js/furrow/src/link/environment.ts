// SPDX-License-Identifier: Apache-2.0

/** What a connection needs of the machine. Tests pass a clock of their own. */
export interface Environment {
  /** Milliseconds of a monotonic clock. */
  nowMs(): number;
  /** Runs `task` once after `ms` milliseconds. Returns a function that cancels it. */
  after(ms: number, task: () => void): () => void;
  /** A number in [0, 1). */
  random(): number;
  /** False while the program's timers run late on purpose, as in a hidden page. */
  isAwake(): boolean;
}

export const MACHINE: Environment = {
  nowMs: () => performance.now(),
  after: (ms, task) => {
    const timer = setTimeout(task, ms);
    return () => clearTimeout(timer);
  },
  random: () => Math.random(),
  isAwake: () => typeof document === 'undefined' || document.visibilityState === 'visible',
};
