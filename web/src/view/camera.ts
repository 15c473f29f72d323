// SPDX-License-Identifier: Apache-2.0
// The camera, and its response to drags, wheels and keys. Metres in the character's model space
// (right-handed, Y up, the character faces +Z), degrees. All functions are pure.

export type Vec3 = readonly [number, number, number];

export interface Camera {
  eye: Vec3;
  target: Vec3;
  fovDegrees: number;
  /** Goes with the subject, as presets do. */
  follows: boolean;
}

/** As GET /api/cameras gives it. */
export interface CameraPreset {
  name: string;
  eye: Vec3;
  target: Vec3;
  fov_degrees: number;
  follows: boolean;
}

const MAX_PITCH = (89 * Math.PI) / 180;
const NEAREST = 0.03;
const FARTHEST = 20;

export function fromPreset(preset: CameraPreset): Camera {
  return {
    eye: preset.eye,
    target: preset.target,
    fovDegrees: preset.fov_degrees,
    follows: preset.follows,
  };
}

const add = (a: Vec3, b: Vec3): Vec3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const subtract = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const scale = (a: Vec3, s: number): Vec3 => [a[0] * s, a[1] * s, a[2] * s];
const length = (a: Vec3): number => Math.hypot(...a);
const clamp = (x: number, low: number, high: number): number => Math.min(high, Math.max(low, x));

/** Direction as seen from above (yaw, 0: +Z) and its rise (pitch), radians; and the distance. */
function toAngles(v: Vec3): { yaw: number; pitch: number; distance: number } {
  const distance = Math.max(length(v), 1e-6);
  return { yaw: Math.atan2(v[0], v[2]), pitch: Math.asin(clamp(v[1] / distance, -1, 1)), distance };
}

function fromAngles(yaw: number, pitch: number, distance: number): Vec3 {
  const flat = Math.cos(pitch) * distance;
  return [Math.sin(yaw) * flat, Math.sin(pitch) * distance, Math.cos(yaw) * flat];
}

/** Right, up and forward of the picture, unit length. */
function axes(camera: Camera): { right: Vec3; up: Vec3; forward: Vec3 } {
  const { yaw, pitch } = toAngles(subtract(camera.eye, camera.target));
  return {
    right: [Math.cos(yaw), 0, -Math.sin(yaw)],
    up: fromAngles(yaw, pitch + Math.PI / 2, 1),
    forward: scale(fromAngles(yaw, pitch, 1), -1),
  };
}

/** Turns the eye about the target; never over the poles. Positive yaw: the eye goes to the right. */
export function orbit(camera: Camera, yawRadians: number, pitchRadians: number): Camera {
  const { yaw, pitch, distance } = toAngles(subtract(camera.eye, camera.target));
  const turned = clamp(pitch + pitchRadians, -MAX_PITCH, MAX_PITCH);
  return { ...camera, eye: add(camera.target, fromAngles(yaw + yawRadians, turned, distance)) };
}

/** Turns the view about the eye. Positive yaw: looks to the right; positive pitch: up. */
export function look(camera: Camera, yawRadians: number, pitchRadians: number): Camera {
  const { yaw, pitch, distance } = toAngles(subtract(camera.target, camera.eye));
  const turned = clamp(pitch + pitchRadians, -MAX_PITCH, MAX_PITCH);
  return { ...camera, target: add(camera.eye, fromAngles(yaw - yawRadians, turned, distance)) };
}

/** Metres at the target that one picture height shows. */
export function heightAtTarget(camera: Camera): number {
  const distance = length(subtract(camera.eye, camera.target));
  return 2 * distance * Math.tan((camera.fovDegrees * Math.PI) / 360);
}

/** Moves the picture's content by shares of its height: right and down are positive. */
export function pan(camera: Camera, right: number, down: number): Camera {
  const { right: x, up: y } = axes(camera);
  const height = heightAtTarget(camera);
  const by = add(scale(x, -right * height), scale(y, down * height));
  return { ...camera, eye: add(camera.eye, by), target: add(camera.target, by) };
}

/** Brings the eye nearer (factor below 1) or further away. */
export function zoom(camera: Camera, factor: number): Camera {
  const from = subtract(camera.eye, camera.target);
  const distance = clamp(length(from) * factor, NEAREST, FARTHEST);
  return { ...camera, eye: add(camera.target, scale(from, distance / Math.max(length(from), 1e-6))) };
}

/** First person: metres along the view, to its right, and straight up. */
export function walk(camera: Camera, forward: number, right: number, up: number): Camera {
  const { right: x, forward: z } = axes(camera);
  const by = add(add(scale(z, forward), scale(x, right)), [0, up, 0]);
  return { ...camera, eye: add(camera.eye, by), target: add(camera.target, by) };
}

/** Metres a second that suit the distance: slow in front of a pore, brisk across a stage. */
export function walkSpeed(camera: Camera): number {
  return clamp(length(subtract(camera.eye, camera.target)) * 0.8, 0.05, 3);
}

export function sameCamera(a: Camera, b: Camera, tolerance = 1e-4): boolean {
  const near = (p: Vec3, q: Vec3): boolean => length(subtract(p, q)) <= tolerance;
  return near(a.eye, b.eye) && near(a.target, b.target) && a.follows === b.follows &&
    Math.abs(a.fovDegrees - b.fovDegrees) <= tolerance;
}
