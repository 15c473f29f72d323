// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import type { LinkState, PictureRequest, Subscriber } from 'furrow/protocol';
import { Signal } from '../src/ui/signal';
import { LivePicture } from '../src/view/live_picture';
import type { Connection } from '../src/wire/connection';

(globalThis as { document: unknown }).document = { createElement: () => ({ setAttribute: () => {}, append: () => {} }) };

const WANTED = { subject: 'ann', width: 64, height: 64 } as PictureRequest;

function fakeConnection() {
  const link = new Signal<LinkState>('open');
  let numWatching = 0;
  const { watch } = link;
  link.watch = (listener) => {
    const unwatch = watch.call(link, listener);
    ++numWatching;
    return () => {
      --numWatching;
      unwatch();
    };
  };
  const open = new Set<Subscriber>();
  const subscribe = (subscriber: Subscriber) => {
    open.add(subscriber);
    return { close: () => open.delete(subscriber), send: () => 1, askAgain: () => {}, repeat: () => {} };
  };
  return { connection: { link, subscribe } as unknown as Connection, open, numWatching: () => numWatching };
}

test('a picture that is closed leaves nothing behind', () => {
  const { connection, open, numWatching } = fakeConnection();
  const live = new LivePicture(connection);
  live.request(WANTED);
  assert.deepEqual([open.size, numWatching()], [1, 1]);
  live.close();
  assert.deepEqual([open.size, numWatching()], [0, 0]);
});

test('a picture that was refused is asked for again after a pause', () => {
  const { connection, open } = fakeConnection();
  const live = new LivePicture(connection);
  live.request(WANTED);
  const [first] = open;
  first!.onRefused(5, 'too many subscriptions', 1);
  assert.equal(open.size, 0);
  live.request(WANTED);
  assert.equal(open.size, 0);
  live.request(WANTED, performance.now() + 6000);
  assert.equal(open.size, 1);
  assert(!open.has(first!));
  live.request(null);
  assert.equal(open.size, 0);
});
