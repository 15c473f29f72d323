// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import type { MocapInputInfo, SourcesInfo, StreamInfo } from '../src/api';
import { adviseOn } from '../src/panels/source_advice';
import { lossOf, namesOf } from '../src/panels/stream_table';

const PHONE: MocapInputInfo = {
  name: 'livelink_face', option: '--livelink-face', port: 11111, usual_port: 11111, packets: 0, malformed: 0, rejected: 0, rate_hz: 0,
  holder: '', sender: '', age_ms: null, malformed_sender: '', malformed_age_ms: null, rejected_sender: '', rejected_age_ms: null,
};
const OPEN: SourcesInfo = { bind: '0.0.0.0', loopback: false, addresses: ['192.0.2.7'], allow: [], inputs: [PHONE], subjects: [], more_subjects: 0 };

test('each obstacle has its own sentence and remedy', () => {
  const cases: [Partial<MocapInputInfo>, Partial<SourcesInfo>, string, RegExp, RegExp][] = [
    [{ port: null }, {}, 'off', /does not listen/, /--livelink-face 11111/],
    [{}, { bind: '127.0.0.1', loopback: true }, 'blocked', /this computer only \(127\.0\.0\.1\)/, /--bind 0\.0\.0\.0 --open --livelink-face 11111/],
    [{}, {}, 'waiting', /Nothing has arrived/, /firewall/],
    [{ packets: 60, rate_hz: 59.6, sender: '192.0.2.20', age_ms: 10 }, {}, 'receiving', /192\.0\.2\.20, 60 packets per second/, /^$/],
    [{ packets: 60, sender: '192.0.2.20', age_ms: 9000 }, {}, 'waiting', /192\.0\.2\.20 has stopped/, /foreground/],
    [{ packets: 9, malformed_sender: '192.0.2.5', malformed_age_ms: 100 }, {}, 'blocked', /192\.0\.2\.5 are not understood/, /Live Link Face/],
    [{ packets: 9, rejected_sender: '192.0.2.5', rejected_age_ms: 100 }, { allow: ['192.0.2.20'] }, 'blocked', /does not list it/, /--mocap-allow 192\.0\.2\.5/],
    [{ packets: 9, rejected_sender: '192.0.2.5', rejected_age_ms: 100 }, {}, 'blocked', /another sender holds/, /3 s/],
    // A simulator on the daemon's own computer gets through.
    [{ packets: 9, rate_hz: 60, sender: '127.0.0.1', age_ms: 1 }, { bind: '127.0.0.1', loopback: true }, 'receiving', /127\.0\.0\.1/, /^$/],
  ];
  for (const [input, sources, state, words, remedy] of cases) {
    const advice = adviseOn({ ...PHONE, ...input }, { ...OPEN, ...sources });
    assert.equal(advice.state, state, advice.words);
    assert.match(advice.words, words);
    assert.match([advice.todo, advice.command].filter(Boolean).join(' '), remedy);
  }
});

test('a sender that another one keeps out can be accepted, unless it is not allowed', () => {
  const rejected = { packets: 9, rejected_sender: '192.0.2.5', rejected_age_ms: 100 };
  const receiving = { ...rejected, rate_hz: 60, sender: '192.0.2.20', age_ms: 5 };
  const acceptOf = (input: Partial<MocapInputInfo>, sources: Partial<SourcesInfo> = {}) => adviseOn({ ...PHONE, ...input }, { ...OPEN, ...sources }).accept;
  assert.equal(acceptOf(rejected), '192.0.2.5');
  assert.equal(acceptOf(receiving), '192.0.2.5');
  assert.match(adviseOn({ ...PHONE, ...receiving }, OPEN).todo, /192\.0\.2\.5 is also sending/);
  assert.equal(acceptOf(receiving, { allow: ['192.0.2.5', '192.0.2.20'] }), '192.0.2.5');
  assert.equal(acceptOf(rejected, { allow: ['192.0.2.20'] }), '');
  assert.equal(acceptOf({ ...receiving, rejected_age_ms: 9000 }), '', 'it has stopped');
  assert.equal(acceptOf({ ...receiving, holder: '192.0.2.5' }), '', 'it has been accepted a moment ago');
  assert.equal(adviseOn({ ...PHONE, ...rejected, holder: '192.0.2.5' }, OPEN).state, 'waiting', 'its next packet counts');
  assert.equal(acceptOf({ packets: 1, sender: '192.0.2.20', age_ms: 5 }), '');
});

test('names that are missing or move nothing are counted', () => {
  const none = { count: 0, names: [] };
  const stream = { missing_joints: none, missing_blend_shapes: none, ignored_joints: none } as unknown as StreamInfo;
  assert.equal(namesOf(stream), '');
  assert.equal(namesOf({ ...stream, missing_joints: { count: 2, names: ['a', 'b'] }, missing_blend_shapes: { count: 1, names: ['c'] } }), '3 names are missing');
  assert.equal(namesOf({ ...stream, missing_joints: { count: 1, names: ['a'] }, ignored_joints: { count: 40, names: [] } }), '1 name is missing, 40 joints are ignored');
  assert.equal(lossOf(90, 10), '10.0 %');
  assert.equal(lossOf(0, 0), '0');
});
