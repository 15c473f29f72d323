// SPDX-License-Identifier: Apache-2.0

/** A value that others watch. Listeners run in the order in which they came. */
export class Signal<T> {
  private readonly listeners = new Set<(value: T) => void>();

  constructor(private current: T) {}

  get value(): T {
    return this.current;
  }

  set(value: T): void {
    if (Object.is(value, this.current)) return;
    this.current = value;
    this.tell();
  }

  /** For a value that was changed in place. */
  tell(): void {
    for (const listener of [...this.listeners]) listener(this.current);
  }

  /** Called on every change from now on; the answer ends it. */
  watch(listener: (value: T) => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  /** As watch(), and at once with the value that there is. */
  bind(listener: (value: T) => void): () => void {
    listener(this.current);
    return this.watch(listener);
  }
}
