// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { decide, type DrawSituation, isSoftware } from '../src/view/draw_choice';

/** A fast GPU, and everything is there. */
const READY: DrawSituation = {
  choice: 'auto', isConnected: true, gpu: 'GeForce', isSpecial: false, whyNoSkin: '', hasNeutral: false, character: 'ready', fits: true, browserHz: 60, daemonHz: 7,
};
const step = (change: Partial<DrawSituation>): string => decide({ ...READY, ...change }).step;

test('the faster one draws', () => {
  assert.deepEqual(decide(READY), { step: 'browser', why: '' });
  assert.equal(step({ browserHz: 30, daemonHz: 60 }), 'daemon');
  assert.equal(step({ browserHz: 60, daemonHz: 58 }), 'daemon'); // no reason to change
  assert.equal(step({ browserHz: 8, daemonHz: 2 }), 'daemon'); // neither is pleasant
  assert.match(decide({ ...READY, browserHz: 30, daemonHz: 60 }).why, /60 pictures per second, and 30 here/);
});

test('the daemon draws first', () => {
  assert.equal(step({ character: 'unknown', fits: null, browserHz: null, daemonHz: 0 }), 'daemon');
  assert.equal(step({ character: 'unknown', fits: null, browserHz: null }), 'load');
  assert.equal(step({ character: 'loading', fits: null, browserHz: null }), 'daemon');
  assert.equal(step({ fits: null, browserHz: null }), 'daemon');
  assert.equal(step({ browserHz: null }), 'measure');
  // After a change of shading, neither rate is known, and the daemon's comes first.
  assert.equal(step({ browserHz: null, daemonHz: 0 }), 'daemon');
  assert.equal(step({ choice: 'browser', browserHz: null, daemonHz: 0 }), 'measure');
});

test('the daemon draws what the browser cannot', () => {
  for (const change of [{ isConnected: false }, { gpu: '' }, { gpu: 'ANGLE (Google, Vulkan (SwiftShader))' }, { isSpecial: true },
    { whyNoSkin: 'this GPU is old' }, { hasNeutral: true },
    { character: 'none' as const }, { character: 'failed' as const }, { fits: false }]) {
    const decision = decide({ ...READY, ...change });
    assert.equal(decision.step, 'daemon', JSON.stringify(change));
    assert.notEqual(decision.why, '');
  }
});

test('users may choose', () => {
  assert.equal(step({ choice: 'daemon' }), 'daemon');
  assert.equal(step({ choice: 'browser', gpu: 'llvmpipe (LLVM 15)', browserHz: 2, daemonHz: 30 }), 'browser');
  assert.equal(step({ choice: 'browser', character: 'unknown', daemonHz: 0 }), 'load');
  assert.equal(step({ choice: 'browser', isSpecial: true }), 'daemon');
  assert.equal(step({ choice: 'browser', gpu: '' }), 'daemon');
});

test('GPUs in software are known', () => {
  for (const name of ['llvmpipe (LLVM 15.0.6, 256 bits)', 'ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device))', 'Microsoft Basic Render Driver']) {
    assert(isSoftware(name), name);
  }
  assert(!isSoftware('ANGLE (Apple, ANGLE Metal Renderer: Apple M2)'));
});
