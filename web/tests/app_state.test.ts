// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { AppState } from '../src/state/app_state';

test('the user’s choice of a subject ends following', () => {
  const state = new AppState('#follow=1&subject=ann');
  assert.equal(state.follows.value, true);
  state.chooseSubject('bob');
  assert.deepEqual([state.subject.value, state.follows.value], ['bob', false]);
});

test('a layout is recognised whatever the order of its parts, and with what it leaves as usual', () => {
  const state = new AppState('');
  const layout = (text: string) => new Map(new URLSearchParams(text));
  assert.equal(state.isArranged(layout('')), true);
  assert.equal(state.isArranged(layout('panel=look')), true); // as usual on a large screen
  assert.equal(state.isArranged(layout('panel=&dock=0')), false);
  state.arrange(layout('dock=0&grid=1&panel='));
  assert.equal(state.isArranged(layout('panel=&dock=0&grid=1')), true);
  state.subject.set('ann'); // is part of no layout
  assert.equal(state.isArranged(state.layout()), true);
  state.arrange(layout(''));
  assert.equal(state.panel.value, 'look');
});

/** Runs `use` in a page at `href`. `use` gets a function that ends the wait before the address is written, and returns it. */
function inPage(href: string, use: (written: () => string) => void): void {
  const globals = globalThis as unknown as {
    location: { href: string };
    history: { replaceState(data: null, unused: string, url: string): void };
    setTimeout(task: () => void): number;
  };
  const { setTimeout } = globals;
  globals.location = { href };
  let write = (): void => {};
  globals.setTimeout = (task) => ((write = task), 1);
  globals.history = { replaceState: (_data, _unused, url) => (globals.location.href = url) };
  try {
    use(() => (write(), globals.location.href));
  } finally {
    globals.setTimeout = setTimeout;
  }
}

test('a link has the present state, also while the turntable runs', () => {
  inPage('http://host/embed?x=1#subject=ann', (written) => {
    const state = new AppState('#subject=ann');
    assert.equal(state.link(), 'http://host/embed?x=1#subject=ann');
    state.begin([]);
    state.turning.set(true);
    state.dock.set(false);
    assert.equal(state.link(), 'http://host/embed?x=1#subject=ann&dock=0');
    assert.equal(written(), state.link());
  });
});

test('the address follows what has changed before the daemon replied', () => {
  inPage('http://host/#subject=ann&follow=1', (written) => {
    const state = new AppState('#subject=ann&follow=1');
    state.subject.set('bob'); // who moves
    assert.equal(written(), 'http://host/#subject=ann&follow=1');
    state.begin([]);
    assert.equal(written(), 'http://host/#subject=bob&follow=1');
  });
});

test('an address stays as it was entered until something changes', () => {
  inPage('http://host/#follow=1&subject=ann', (written) => {
    new AppState('#follow=1&subject=ann').begin([]);
    assert.equal(written(), 'http://host/#follow=1&subject=ann');
  });
});
