// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import type { MocapInputInfo, SourcesInfo } from '../src/api';
import { adviseOn } from '../src/panels/source_advice';

const PHONE: MocapInputInfo = {
  name: 'livelink_face', option: '--livelink-face', port: 11111, usual_port: 11111, packets: 0, malformed: 0, rejected: 0, rate_hz: 0,
  sender: '', age_ms: null, malformed_sender: '', malformed_age_ms: null, rejected_sender: '', rejected_age_ms: null,
};
const OPEN: SourcesInfo = { bind: '0.0.0.0', loopback: false, addresses: ['192.0.2.7'], allow: [], inputs: [PHONE] };

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
