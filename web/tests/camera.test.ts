// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import test from 'node:test';
import { type Camera, heightAtTarget, look, orbit, pan, sameCamera, type Vec3, walk, zoom } from '../src/view/camera';

const FRONT: Camera = { eye: [0, 1.5, 1], target: [0, 1.5, 0], fovDegrees: 90, follows: true };

function near(actual: Vec3, expected: Vec3): void {
  assert(actual.every((x, i) => Math.abs(x - expected[i]!) < 1e-9), `${actual} is not ${expected}`);
}
const distance = (c: Camera): number => Math.hypot(c.eye[0] - c.target[0], c.eye[1] - c.target[1], c.eye[2] - c.target[2]);

test('a quarter turn to the right looks from +X', () => {
  near(orbit(FRONT, Math.PI / 2, 0).eye, [1, 1.5, 0]);
  near(orbit(FRONT, 0, Math.PI / 4).eye, [0, 1.5 + Math.SQRT1_2, Math.SQRT1_2]);
});

test('orbit keeps target and distance and never goes over the pole', () => {
  let camera = FRONT;
  for (let i = 0; i < 100; ++i) camera = orbit(camera, 0.3, 0.2);
  assert(Math.abs(distance(camera) - 1) < 1e-9);
  near(camera.target, FRONT.target);
  assert(camera.eye[1] < FRONT.target[1] + 1 && camera.eye[1] > 2.49);
});

test('looking right moves the target to the left of the picture', () => {
  // The camera looks along -Z, so its right is +X.
  near(look(FRONT, Math.PI / 2, 0).target, [1, 1.5, 1]);
  near(look(FRONT, 0, 0.1).eye, FRONT.eye);
});

test('panning by the picture height moves by the visible height', () => {
  assert(Math.abs(heightAtTarget(FRONT) - 2) < 1e-9); // 90 degrees at 1 m
  const moved = pan(FRONT, 0.5, 0.25); // the content moves right and down, the camera left and up
  near(moved.eye, [-1, 2, 1]);
  near(moved.target, [-1, 2, 0]);
});

test('zoom follows the view direction and is limited', () => {
  near(zoom(FRONT, 0.5).eye, [0, 1.5, 0.5]);
  assert(Math.abs(distance(zoom(FRONT, 1e-9)) - 0.03) < 1e-9);
  assert(Math.abs(distance(zoom(FRONT, 1e9)) - 20) < 1e-9);
});

test('walking moves forward, right and up', () => {
  near(walk(FRONT, 0.5, 0, 0).eye, [0, 1.5, 0.5]);
  near(walk(FRONT, 0, 0.5, 0.25).target, [0.5, 1.75, 0]);
  const aside = orbit(FRONT, Math.PI / 2, 0); // looks along -X, so its right is -Z
  near(walk(aside, 0, 1, 0).eye, [1, 1.5, -1]);
});

test('camera comparison ignores rounding', () => {
  assert(sameCamera(FRONT, { ...FRONT, eye: [0.00001, 1.5, 1] }));
  assert(!sameCamera(FRONT, orbit(FRONT, 0.01, 0)));
  assert(!sameCamera(FRONT, { ...FRONT, follows: false }));
});
