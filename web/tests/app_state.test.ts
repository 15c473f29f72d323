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
