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

test('a link has the present state, also while the turntable runs', () => {
  const globals = globalThis as unknown as {
    location: { href: string };
    history: { replaceState(data: null, unused: string, url: string): void };
    setTimeout(task: () => void): number;
  };
  const { setTimeout } = globals;
  globals.location = { href: 'http://host/embed?x=1#subject=ann' };
  let write = (): void => {};
  globals.setTimeout = (task) => ((write = task), 1);
  let written = '';
  globals.history = { replaceState: (_data, _unused, url) => (written = url) };
  const state = new AppState('#subject=ann');
  assert.equal(state.link(), 'http://host/embed?x=1#subject=ann');
  state.begin([]);
  state.turning.set(true);
  state.dock.set(false);
  assert.equal(state.link(), 'http://host/embed?x=1#subject=ann&dock=0');
  globals.setTimeout = setTimeout;
  write();
  assert.equal(written, state.link());
});
