// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { ENVIRONMENT_SETTINGS, ENVIRONMENTS, swatchOf } from '../src/light/environments';
import { CARD, dragged, exposureFor, isBackground, isOfLight, linearOf, type Rgb, turntableRadians, withinRange } from '../src/light/light_math';

test('a drag turns the lamps around, and tilts them to the poles', () => {
  assert.deepEqual(dragged({ turn: 0, tilt: 0 }, 0.25, 0.1), { turn: 45, tilt: 18 });
  assert.deepEqual(dragged({ turn: 170, tilt: 80 }, 0.2, 0.2), { turn: -154, tilt: 90 });
  assert.deepEqual(dragged({ turn: -170, tilt: -80 }, -0.2, -0.2), { turn: 154, tilt: -90 });
});

const near = (a: Rgb, b: Rgb) => a.every((value, i) => Math.abs(value - b[i]!) < 2e-3);

test('colours of the picture lead back to the light before the tone map', () => {
  assert(near(linearOf([0, 118, 255], false), [0, 0.1812, 1]));
  assert(near(linearOf([10, 118, 118], true), [0.003, 0.1812, 0.1812])); // below 0.76, the tone map changes nothing
  // shaders/post/tonemap.glsl maps 2 to 1 - 0.24² / (2 - 0.52) = 0.9611, which is 250.57 in sRGB.
  assert(Math.abs(linearOf([0, 0, 250.57], true)[2] - 2) < 0.02);
});

test('a point becomes as bright as a grey card', () => {
  const grey: Rgb = [0.09, 0.09, 0.09];
  assert(Math.abs(exposureFor(grey, 1)! - CARD / 0.09) < 1e-9);
  assert(Math.abs(exposureFor(grey, 0.5)! - 1) < 1e-9);
  assert.equal(exposureFor([0, 0, 0], 1), null);
  assert.equal(exposureFor(grey, 0), null);
  assert.deepEqual([180, 1.234, 0.001].map((exposure) => withinRange(exposure, 16)), [16, 1.23, 0.01]);
});

test('only pictures of light are measured', () => {
  assert.deepEqual(['final', 'weights', 'specular', 'normal', 'albedo', 'occlusion'].map(isOfLight), [true, true, true, false, false, false]);
});

test('the background is recognised', () => {
  assert.equal(isBackground([47, 48, 49], [0.028, 0.029, 0.031], true), true);
  assert.equal(isBackground([60, 48, 49], [0.028, 0.029, 0.031], true), false);
  // tonemap.glsl maps 2 to 1 - 0.24² / (2 - 0.52) = 0.9611, which is 250.57 in sRGB; without it, 2 is clipped.
  assert.equal(isBackground([251, 251, 251], [2, 2, 2], true), true);
  assert.equal(isBackground([255, 255, 255], [2, 2, 2], true), false);
  assert.equal(isBackground([255, 255, 255], [2, 2, 2], false), true);
});

test('the turntable takes 16 s for a turn, with reduced motion in steps', () => {
  assert(Math.abs(turntableRadians(16, false) - 2 * Math.PI) < 1e-9);
  assert.equal(turntableRadians(1.9, true), 0);
  assert(Math.abs(turntableRadians(3.9, true) - Math.PI / 4) < 1e-9);
});

test('environments change lamps, sky and exposure, all of them and nothing else', () => {
  assert.deepEqual([...ENVIRONMENT_SETTINGS].sort(), ['exposure', ...['ambient', 'fill', 'intensity', 'key', 'preset', 'rim', 'sky',
    'tilt_degrees', 'turn_degrees'].map((name) => `lights.${name}`)]);
  for (const { name, values } of ENVIRONMENTS) assert.deepEqual([...values.keys()], ENVIRONMENT_SETTINGS, name);
});

test('each environment has a swatch of its own, without colours that a screen does not have', () => {
  const swatches = ENVIRONMENTS.map(({ values }) => swatchOf(values));
  assert.equal(new Set(swatches).size, ENVIRONMENTS.length);
  for (const swatch of swatches) {
    const bytes = [...swatch.matchAll(/rgb\((\d+) (\d+) (\d+)\)/g)].flatMap(([, ...channels]) => channels.map(Number));
    assert.equal(bytes.length, 9, swatch);
    assert(bytes.every((byte) => byte <= 255), swatch);
  }
  // A lamp without a filter of its own is the lamp of the preset: white lamps of equal channels give grey.
  assert.match(swatchOf(ENVIRONMENTS.find(({ name }) => name === 'neutral')!.values), /gradient\(circle at \d+% \d+%, rgb\((\d+) \1 \1\)/);
});
