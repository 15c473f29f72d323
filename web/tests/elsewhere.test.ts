// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { readAddress } from '../src/state/address';
import { Elsewhere } from '../src/state/elsewhere';

const B = 'https://host-b:7480';

/** A page at `link`. `tick()` runs the timers that nobody has cleared. */
function page(link: string) {
  const globals = globalThis as unknown as { setTimeout(task: () => void): number; clearTimeout(timer: number): void };
  const timers = new Map<number, () => void>();
  let last = 0;
  globals.setTimeout = (task) => (timers.set(++last, task), last);
  globals.clearTimeout = (timer) => timers.delete(timer);
  const urls: string[] = [];
  const errors: string[] = [];
  const elsewhere = new Elsewhere(new URL(link).hash, {
    link: () => link, go: (url) => urls.push(url), say: (words, kind) => kind === 'error' && errors.push(words),
  });
  const tick = (): void => {
    for (const [timer, task] of [...timers]) {
      timers.delete(timer);
      task();
    }
  };
  return { elsewhere, urls, errors, tick };
}

test('the page goes once, with its settings, and without the query', () => {
  const { elsewhere, urls, errors, tick } = page('http://host-a:7480/embed?token=x#subject=ada&curves=a.b,c');
  elsewhere.follow(B);
  elsewhere.follow(B);
  assert.deepEqual(urls, []);
  tick();
  tick();
  assert.equal(urls.length, 1);
  const { origin, pathname, search, hash } = new URL(urls[0]!);
  assert.deepEqual([origin, pathname, search], [B, '/embed', '']);
  const state = readAddress(hash);
  assert.deepEqual([state.subject, state.curves, state.settings.size], ['ada', ['a.b', 'c'], 0]);
  assert.deepEqual(errors, []);
});

test('another subject, or an answer of this daemon, keeps the page where it is', () => {
  const { elsewhere, urls, tick } = page('http://host-a:7480/#subject=ada');
  elsewhere.follow(B);
  elsewhere.reset();
  tick();
  assert.deepEqual(urls, []);
});

test('the page never goes from HTTPS to HTTP', () => {
  const { elsewhere, urls, errors, tick } = page('https://host-a:7480/#subject=ada');
  elsewhere.follow('http://host-b:7480');
  tick();
  assert.deepEqual(urls, []);
  assert.match(errors[0]!, /http:\/\/host-b:7480/);
  elsewhere.follow(B);
  tick();
  assert.equal(urls.length, 1);
});

test('daemons that contradict each other move the page four times at most', () => {
  let url = 'http://host-a:7480/#subject=ada';
  for (let moves = 0; ; ++moves) {
    const { elsewhere, urls, errors, tick } = page(url);
    elsewhere.follow(B);
    tick();
    if (urls.length === 0) {
      assert.equal(moves, 4);
      assert.match(errors[0]!, /https:\/\/host-b:7480/);
      // Once a daemon has served the subject, there is no contradiction any more.
      elsewhere.reset();
      elsewhere.follow(B);
      tick();
      assert.equal(new URLSearchParams(new URL(urls[0]!).hash.slice(1)).get('moves'), '1');
      return;
    }
    assert(moves < 9);
    url = urls[0]!;
  }
});

test('a number of moves that is not one counts as none', () => {
  for (const moves of ['', '-5', 'x', '1e9', '99999']) {
    const { elsewhere, urls, tick } = page(`http://host-a:7480/#subject=ada&moves=${moves}`);
    elsewhere.follow(B);
    tick();
    assert.equal(urls.length, 1, moves);
  }
});
