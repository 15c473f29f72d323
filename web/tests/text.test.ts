// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { addressOf, readAddress, writeAddress } from '../src/state/address';
import { fromToml, toToml } from '../src/state/toml';
import { someSettings } from './some_settings';

test('TOML has plain names first, then tables, and reads back equal', () => {
  const values = new Map([
    ['shadow.taps', '12'], ['view', 'normal'], ['shadow.softness_mm', '4.5'], ['wrinkles', 'off'],
    ['background', '0.1,0.2,0.3'], ['strip.views', 'final,normal'],
  ]);
  const toml = toToml(someSettings(), values);
  assert.equal(toml, 'view = "normal"\nwrinkles = false\nbackground = [0.1, 0.2, 0.3]\n\n[shadow]\n' +
    'softness_mm = 4.5  # mm\ntaps = 12\n\n[strip]\nviews = ["final","normal"]\n');
  assert.deepEqual(Object.fromEntries(fromToml(toml)), Object.fromEntries(values));
});

test('no changes give no text', () => assert.equal(toToml(someSettings(), new Map()), ''));

test('TOML: comments, underscores, quoted hashes, negative numbers', () => {
  const values = fromToml('# a\n[a]\nb = -1_000.5 # c\nd = "x # y"\n\n[e]\nf = true\n');
  assert.deepEqual(Object.fromEntries(values), { 'a.b': '-1000.5', 'a.d': 'x # y', 'e.f': 'on' });
});

test('errors in TOML name the line', () => {
  for (const [text, line] of [['a = 1\nb', 2], ['a = word', 1], ['a = [1, ', 1], ['= 3', 1], ['a = {}', 1]] as const) {
    assert.throws(() => fromToml(text), new RegExp(`Line ${line}:`));
  }
});

test('the URL restores the page', () => {
  const state = {
    subject: 'stage left & right', wipe: 'shading' as const, strip: ['normal', 'depth'], curves: ['brow_l.squash'], panel: '',
    drawnBy: 'browser' as const, stream: 'jpeg' as const, kiosk: true, grid: true, follows: true, against: 'take & 7', dock: false,
    camera: { eye: [0.1, 1.6, 0.8] as const, target: [0, 1.6, 0] as const, fovDegrees: 24, follows: true },
    settings: new Map([['shading', 'skin'], ['background', '0.1,0.2,0.3'], ['subsurface.width', '1.2']]),
  };
  const hash = writeAddress(state);
  assert.deepEqual(readAddress(hash), state);
  assert.match(hash, /subsurface\.width=1\.2/);
});

test('the default page has an empty fragment', () => {
  assert.equal(writeAddress(readAddress('')), '');
  assert.equal(readAddress('#camera=eyes').camera, 'eyes');
});

test('invalid parts of the URL are ignored', () => {
  assert.equal(readAddress('#camera=1,2,x,4,5,6,7,8').camera, null);
  assert.equal(readAddress('#camera=0,0,1,0,0,0,400,1').camera, null);
  assert.equal(readAddress('#wipe=upside').wipe, 'none');
  assert.equal(readAddress('#drawn=nobody').drawnBy, 'auto');
  assert.equal(readAddress('#stream=mpeg').stream, 'auto');
  assert.equal(readAddress('#stream=h264').stream, 'h264');
});

test('the query of a frame is its address, until the page has one of its own', () => {
  assert.equal(addressOf({ hash: '', search: '?camera=face&token=frw1_x' }), '#camera=face');
  assert.equal(addressOf({ hash: '#camera=body', search: '?camera=face' }), '#camera=body');
  assert.equal(readAddress(addressOf({ hash: '', search: '' })).settings.size, 0);
});
