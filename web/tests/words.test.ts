// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { ApiError, type Explanation, type Playback } from '../src/api';
import { assess, isDimmed, type PictureState, type Situation } from '../src/panels/condition';
import { afterwardsWords, contributionWords } from '../src/panels/explain';
import { colourOf } from '../src/panels/face_map';
import { positionAfter } from '../src/panels/timeline';
import { clockText } from '../src/ui/clock';

const GOOD: Situation = {
  link: 'open', everConnected: true, notDrawn: '', renders: true, wanted: '', hasPicture: true,
  silentMs: 100, drawing: null, isDraft: false, pictureMs: 40, everyMs: 0, isChanging: false, limit: 'drawing', isAtRest: false, isPaused: false,
  subjects: [{ name: 'demo', state: 'live', age_ms: 8 }],
};

test('each condition has its own sentence', () => {
  const cases: [Partial<Situation>, PictureState, RegExp][] = [
    [{}, 'live', /Live: demo/],
    [{ link: 'lost' }, 'lost', /Connection lost/],
    [{ link: 'lost', everConnected: false }, 'lost', /No daemon responds/],
    [{ link: 'draining' }, 'lost', /shutting down/],
    [{ link: 'connecting' }, 'loading', /Connecting/],
    [{ subjects: null }, 'loading', /Connecting/],
    [{ silentMs: 4000 }, 'stale', /not answered for 4 s/],
    [{ subjects: [] }, 'empty', /No subject is streaming/],
    [{ wanted: 'other' }, 'empty', /“other” is not streaming/],
    [{ renders: false }, 'off', /does not render pictures/],
    [{ notDrawn: 'no EGL device' }, 'off', /does not render pictures/],
    [{ subjects: [{ name: 'demo', state: 'waiting', age_ms: 0 }] }, 'empty', /no pose yet/],
    [{ subjects: [{ name: 'demo', state: 'lost', age_ms: 4200 }] }, 'lost', /No data from “demo” for 4 s/],
    [{ subjects: [{ name: 'demo', state: 'no_face', age_ms: 4200 }] }, 'stale', /“demo” sees no face/],
    [{ subjects: [{ name: 'demo', state: 'ended', age_ms: 0 }] }, 'empty', /No subject is streaming/],
    [{ hasPicture: false }, 'loading', /first picture/],
    [{ hasPicture: false, drawing: { done: 3, passes: 12 } }, 'loading', /step 4 of 12/],
    [{ drawing: { done: 3, passes: 12 } }, 'live', /Live/],
    [{ isDraft: true }, 'live', /Live: demo \(draft\)/],
    [{ isPaused: true, pictureMs: 9000 }, 'paused', /Paused: demo/],
    [{ pictureMs: 3000 }, 'stale', /3 s old/],
    [{ pictureMs: 3000, isChanging: true, drawing: { done: 1, passes: 9 } }, 'stale', /3 s old/],
    [{ pictureMs: 3000, isAtRest: true }, 'live', /Live/],
    [{ pictureMs: 5000, everyMs: 4000 }, 'live', /Live/], // a tile among many
    [{ pictureMs: 7000, everyMs: 4000 }, 'stale', /7 s old/],
  ];
  for (const [part, state, text] of cases) {
    const condition = assess({ ...GOOD, ...part });
    assert.equal(condition.state, state, condition.text);
    assert.match(condition.text, text);
  }
  assert.match(assess({ ...GOOD, pictureMs: 3000, isChanging: true, drawing: { done: 1, passes: 9 } }).advice, /step 2 of 9/);
  assert.match(assess({ ...GOOD, pictureMs: 3000, drawing: { done: 1, passes: 9 } }).advice, /Fast.*Diffuse/);
  assert.match(assess({ ...GOOD, pictureMs: 3000, limit: 'network' }).advice, /network/);
  assert.equal(assess({ ...GOOD, hasPicture: false, drawing: { done: 3, passes: 12 } }).progress, 0.25);
  assert.deepEqual((['live', 'paused', 'stale', 'lost'] as const).map(isDimmed), [false, false, true, true]);
  assert.equal(assess({ ...GOOD, notDrawn: 'no EGL device' }).advice, 'no EGL device');
});

test('an API error names field and remedy', () => {
  assert.equal(new ApiError(400, 'subsurface.width', '12 is invalid (valid: [0, 8])').words(), 'subsurface.width: 12 is invalid (valid: [0, 8])');
  assert.equal(new ApiError(409, '', 'nothing to undo', 'capture first').words(), 'nothing to undo (capture first)');
});

const CONTRIBUTION = { value: 'brow_inner_l.squash', kind: 'pose', reference_pose: 'squash', driver_value: 0.44, gain: 1, product: 0.44, pose: null, angles: null, strain: null, blend_shapes: null };
const EXPLANATION: Explanation = { subject: 'demo', sequence: 1, weight: 'brow_l.squash', live: 0.4, result: 0.4, combined: 0.4, modulated: 0.4, contributions: [], conflicts: [] };

test('contributions are described in a sentence', () => {
  assert.match(contributionWords({ ...CONTRIBUTION, pose: { along: 0.44, perpendicular: 0, falloff: 1 } }), /^44 % of the way to the pose “squash”$/);
  assert.match(contributionWords({ ...CONTRIBUTION, pose: { along: 0.44, perpendicular: 0.1, falloff: 0.5 } }), /reduced to 50 %/);
  assert.equal(contributionWords({ ...CONTRIBUTION, angles: [{ what: 'flexion', degrees: 12.34 }] }), 'flexion 12.3°');
  assert.match(contributionWords({ ...CONTRIBUTION, strain: { smallest: 0.8, largest: 1.05, degrees: 0 } }), /80 % to 105 %/);
  assert.equal(contributionWords(CONTRIBUTION), 'the coefficient of the blend shape');
  const blend_shapes = ['a', 'b', 'c', 'd', 'e', 'f'].map((name, i) => ({ name, coefficient: 0.9 - 0.1 * i }));
  assert.equal(contributionWords({ ...CONTRIBUTION, blend_shapes: blend_shapes.slice(0, 2) }), 'a 0.90, b 0.80');
  assert.match(contributionWords({ ...CONTRIBUTION, blend_shapes }), /d 0.60, 2 more blend shapes$/);
  assert.equal(contributionWords({ ...CONTRIBUTION, blend_shapes: [{ name: 'a', coefficient: 0 }] }), 'the coefficient of the blend shape');
});

test('steps without an effect are not described', () => {
  assert.deepEqual(afterwardsWords(EXPLANATION), []);
  const all = afterwardsWords({ ...EXPLANATION, modulated: 0.3, live: 0.1, conflicts: [{ weight: 'brow_l.stretch', other: 0.5, factor: 0.7 }] });
  assert.equal(all.length, 3);
});

const PLAYBACK: Playback = { file: 'a.bvh', subject: 'a', uploaded: false, frames: 600, seconds: 10, rate_hz: 60, position_s: 9, frame: 540, playing: true, loop: true, speed: 2 };

test('the timeline advances between replies', () => {
  assert.equal(positionAfter(PLAYBACK, 0.25), 9.5);
  assert.equal(positionAfter(PLAYBACK, 1), 1); // wraps around at the end
  assert.equal(positionAfter({ ...PLAYBACK, loop: false }, 1), 10);
  assert.equal(positionAfter({ ...PLAYBACK, playing: false }, 1), 9);
  assert.equal(clockText(75.04, 1), '1:15.0');
  assert.equal(clockText(3.2, 1), '0:03.2');
  assert.equal(clockText(59.97, 1), '0:59.9');
  assert.equal(clockText(60), '1:00');
  assert.equal(clockText(9.9), '0:09');
});

test('the face map is warm for compressed skin, cool for stretched skin, grey at rest', () => {
  assert.equal(colourOf(1, 0.2), 'hsl(28 85% 60%)');
  assert.equal(colourOf(0.2, 1), 'hsl(205 85% 60%)');
  assert.equal(colourOf(0, 0), 'hsl(28 0% 22%)');
});
