// SPDX-License-Identifier: Apache-2.0

/** A value with listeners. Listeners run in the order in which they were added. */
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

  /** Notifies the listeners after the value was changed in place. */
  tell(): void {
    for (const listener of [...this.listeners]) listener(this.current);
  }

  /** Calls the listener on every change. Returns a function that removes the listener. */
  watch(listener: (value: T) => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  /** Like watch(), but also calls the listener at once with the current value. */
  bind(listener: (value: T) => void): () => void {
    listener(this.current);
    return this.watch(listener);
  }
}
