// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { glslOf } from '../src/skin/glsl.js';

test('shaders lose what GLSL ES 3.00 does not have', () => {
  const text = glslOf('skin/light.frag.glsl', { SHADOW_TAPS: 8, OCCLUSION: true, CONSERVE: false });
  assert(text.startsWith('#define SHADOW_TAPS 8\n#define OCCLUSION 1\n#define CONSERVE 0\n'));
  assert.doesNotMatch(text, /layout\((binding|location = \d+\) uniform|std140)/);
  assert.doesNotMatch(text, /#include|uniform Frame/);
  // The members of the block are uniforms of their own, and outputs keep their places.
  assert.match(text, /uniform Light u_lights\[NUM_LIGHTS\];/);
  assert.match(text, /layout\(location = 1\) out vec4 f_radiance;/);
});

test('a file is included once', () => {
  const text = glslOf('skin/light.frag.glsl');
  assert.equal(text.match(/float saturate\(float x\)/g)?.length, 1);
});

test('an unknown shader is an error that names it', () => {
  assert.throws(() => glslOf('skin/none.glsl'), /no shader 'skin\/none.glsl'/);
});
