// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { join } from 'node:path';
import test from 'node:test';
import { defaultSettings, readSettings } from '../src/settings.js';

/** What `furrow render --print-settings` states, as names and values in the daemon's text form. */
function stated(): [string, string][] {
  const toml = execFileSync(join(process.env.FURROW_BIN!, 'furrow'), ['render', '--print-settings'], { encoding: 'utf8' });
  let table = '';
  return toml.split('\n').flatMap((line): [string, string][] => {
    const header = /^\[(\w+)\]$/.exec(line)?.[1];
    if (header !== undefined) table = `${header}.`;
    const [, name, value] = /^(\w+) = (.*)$/.exec(line) ?? [];
    if (name === undefined) return [];
    return [[table + name, value!.replace(/^["[]|["\]]$/g, '').replace(/^true$/, 'on').replace(/^false$/, 'off')]];
  });
}

test('the defaults are those of the renderer', () => {
  // `furrow render` draws four samples, furrowd as many as the device can afford.
  const values = stated().filter(([name]) => name !== 'anti_aliasing.samples');
  assert(values.length > 60, `${values.length} settings`);
  const { settings, unsupported } = readSettings(values);
  assert.deepEqual(unsupported, []);
  assert.deepEqual(settings, defaultSettings());
  // Every setting here exists there.
  const names = new Set(values.map(([name]) => name));
  for (const [name, value] of Object.entries(defaultSettings())) {
    const inner = typeof value === 'object' && !Array.isArray(value) ? Object.keys(value).map((key) => `${name}.${key}`) : [name];
    for (const each of inner) assert(names.has(each), each);
  }
});

test('values in text form become settings', () => {
  const { settings, unsupported } = readSettings([
    ['shading', 'skin'], ['shadow.filter', 'pcss'], ['shadow.lamps', '2'], ['subsurface.method', 'off'], ['translucency.enabled', 'off'],
    ['lights.key', '1,0.5,0.25'], ['bloom.strength', '0'], ['view', 'specular'],
  ]);
  assert.deepEqual(unsupported, []);
  assert.equal(settings.shading, 'skin');
  assert.deepEqual(settings.shadow, { ...defaultSettings().shadow, filter: 'pcss', lamps: 2 });
  assert.deepEqual([settings.subsurface.method, settings.translucency.enabled, settings.bloom.strength, settings.view], ['off', false, 0, 'specular']);
  assert.deepEqual(settings.lights.key, [1, 0.5, 0.25]);
});

test('what cannot be drawn is named', () => {
  const skin = (name: string, value: string): string[] => readSettings([['shading', 'skin'], [name, value]]).unsupported;
  assert.deepEqual(skin('subsurface.method', 'burley'), ['subsurface.method']);
  assert.deepEqual(skin('view', 'wireframe'), ['view']);
  assert.deepEqual(skin('displacement.enabled', 'on'), ['displacement.enabled']);
  assert.deepEqual(skin('strip.views', 'normal'), ['strip.views']);
  assert.deepEqual(skin('normal_blend', 'tangent_space'), ['normal_blend']);
  assert.deepEqual(skin('anti_aliasing.samples', '8'), ['anti_aliasing.samples']);
  assert.deepEqual(skin('exposure', 'bright'), ['exposure']);
  assert.deepEqual(skin('lights.key', '1,1'), ['lights.key']);
  assert.deepEqual(skin('no_such_setting', '1'), ['no_such_setting']);
  assert.deepEqual(skin('specular.table', 'on'), [], 'another way to the same picture');
  assert.deepEqual(skin('detail.error_pixels', '2'), [], 'only crowds have details');
});

test('with shading "diffuse", settings of skin have no effect', () => {
  const diffuse = (name: string, value: string): string[] => readSettings([['shading', 'diffuse'], [name, value]]).unsupported;
  assert.deepEqual(diffuse('subsurface.method', 'burley'), []);
  assert.deepEqual(diffuse('shadow.filter', 'off'), []);
  assert.deepEqual(diffuse('lights.preset', 'hard'), []);
  assert.deepEqual(diffuse('background', '0,0,0'), []);
  assert.deepEqual(diffuse('exposure', '2'), ['exposure']);
  assert.deepEqual(diffuse('wrinkles', 'off'), ['wrinkles']);
});
