// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { browserWords, captionLines, type PageFacts, timeWords } from '../src/screenshot/caption';
import { wrapped } from '../src/screenshot/page_picture';

const FACTS: PageFacts = {
  date: new Date('2026-11-29T13:30:15Z'), host: 'stage:7480', version: '0.1.0', userAgent: 'Mozilla/5.0 Firefox/145.0',
  width: 1280, height: 720, density: 2, condition: 'Live: ada', figures: [['Age', '12 ms'], ['Limit', 'network']],
  sequence: 42, timecode: '', weights: [['a', 0.2], ['b', 0.9], ['c', 0.001]], fragment: 'shading=skin&subject=a%26b',
};

test('the caption says when, where, what and how to come back', () => {
  const [where, picture, weights, settings, ...more] = captionLines(FACTS);
  assert.match(where!, /^2026-11-29 .* Furrow 0\.1\.0 at stage:7480 .* Firefox 145 .* 1280 × 720 at 2$/);
  assert.match(picture!, /^Live: ada +Age 12 ms +Limit network +Pose 42$/);
  assert.equal(weights, 'Weights: b 0.90, a 0.20');
  assert.match(settings!, /shading=skin +subject=a&b/);
  assert.deepEqual(more, []);
});

test('what is not known leaves no gap in the caption', () => {
  const lines = captionLines({ ...FACTS, version: '', userAgent: '', figures: [], sequence: null, weights: [], fragment: '' });
  assert.equal(lines.length, 3);
  assert.match(lines[0]!, /Furrow at stage:7480 +1280/);
  assert.equal(lines[1], 'Live: ada');
  assert.match(lines[2]!, /those of the daemon/);
  assert.match(captionLines({ ...FACTS, fragment: 'a=%' })[3]!, /a=%/);
});

test('times are local and say how they differ from UTC', () => {
  assert.equal(timeWords(FACTS.date, 60), '2026-11-29 14:30:15 +01:00');
  assert.equal(timeWords(FACTS.date, -210), '2026-11-29 10:00:15 -03:30');
  assert.equal(timeWords(FACTS.date, 0), '2026-11-29 13:30:15 +00:00');
});

test('browsers that resemble others have their own name', () => {
  const chrome = 'Mozilla/5.0 (X11; Linux x86_64) AppleWebKit/537.36 (KHTML, like Gecko) Chrome/142.0.0.0 Safari/537.36';
  assert.equal(browserWords(chrome), 'Chrome 142');
  assert.equal(browserWords(`${chrome} Edg/142.0.1`), 'Edge 142');
  assert.equal(browserWords('Mozilla/5.0 (Macintosh) AppleWebKit/605.1 (KHTML, like Gecko) Version/18.1 Safari/605.1'), 'Safari 18');
  assert.equal(browserWords('curl/8'), '');
});

test('long lines break at spaces, and long words anywhere', () => {
  const fits = (row: string): boolean => row.length <= 8;
  assert.deepEqual(wrapped(['one two three', ''], fits), ['one two', 'three', '']);
  assert.deepEqual(wrapped(['abcdefghijkl mn'], fits), ['abcdefgh', 'ijkl mn']);
  assert.deepEqual(wrapped(['x'], () => false), ['x']); // too narrow for anything
});
