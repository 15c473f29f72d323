// SPDX-License-Identifier: Apache-2.0
// The lamps and the sky of the daemon's pictures: render/scene/lighting.h and render/scene/sky_light.h, in world space.
import { MathUtils, Matrix4, type PerspectiveCamera, Vector2, Vector3, Vector4 } from 'three';
import type { LightSettings, Rgb } from '../settings.js';

export interface Lamp {
  kind: 'spot' | 'point' | 'directional';
  position: Vector3;
  /** Unit, towards the lamp. */
  direction: Vector3;
  /** Linear radiance that a white surface facing the lamp reflects; of spots and points at `reach` metres. */
  radiance: Vector3;
  reach: number;
  coneDegrees: number;
}

/** Radiance from straight above, from the horizon and from straight below. */
export interface Sky {
  zenith: Rgb;
  horizon: Rgb;
  ground: Rgb;
}

export interface Lighting {
  lamps: Lamp[];
  sky: Sky;
}

interface LampOfPreset {
  kind: Lamp['kind'];
  /** In the camera's frame: x to the right, y up, z towards the camera. */
  towards: Rgb;
  radiance: Rgb;
}

const grey = (value: number): Rgb => [value, value, value];

const PRESETS: Record<LightSettings['preset'], { lamps: LampOfPreset[]; sky: Sky }> = {
  studio: {
    lamps: [
      { kind: 'spot', towards: [-0.78, 0.72, 0.76], radiance: [1.12, 0.98, 0.84] },
      { kind: 'point', towards: [0.84, 0.46, 0.52], radiance: [0.22, 0.225, 0.25] },
      { kind: 'directional', towards: [0.58, 0.25, -1.05], radiance: [0.28, 0.31, 0.36] },
    ],
    sky: { zenith: [0.15, 0.155, 0.165], horizon: [0.08, 0.078, 0.078], ground: [0.045, 0.038, 0.034] },
  },
  hard: {
    lamps: [
      { kind: 'spot', towards: [-0.75, 0.95, 0.45], radiance: [2.1, 1.95, 1.78] },
      { kind: 'point', towards: [0.9, 0, 0.6], radiance: grey(0) },
      { kind: 'directional', towards: [0.72, 0.42, -0.75], radiance: grey(0) },
    ],
    sky: { zenith: grey(0.045), horizon: grey(0.028), ground: grey(0.016) },
  },
  thesis: {
    lamps: [
      { kind: 'directional', towards: [-0.75, 0.45, 0.65], radiance: grey(0.75) },
      { kind: 'directional', towards: [0.8, 0.35, 0.6], radiance: grey(0.45) },
      { kind: 'directional', towards: [0.1, 0.6, -0.8], radiance: grey(0.45) },
    ],
    sky: { zenith: grey(0.06), horizon: grey(0.05), ground: grey(0.04) },
  },
};
const CONE_DEGREES = 24;
/** Distance of spots and points from the target, in radii of the stage. */
const LAMP_DISTANCE = 7;

/** Radius in metres around the target that a picture shows, with its corners and a margin. */
export function stageRadius(camera: PerspectiveCamera, distance: number): number {
  return 1.15 * distance * Math.tan((camera.fov * Math.PI) / 360) * new Vector2(camera.aspect, 1).length();
}

/** The lamps turn with the camera, so that every view is lit alike. `target`: what the camera looks at. */
export function makeLighting(settings: LightSettings, camera: PerspectiveCamera, target: Vector3): Lighting {
  const towards = target.clone().sub(camera.position);
  const frame = new Matrix4().makeRotationY(Math.atan2(-towards.x, -towards.z))
    .multiply(new Matrix4().makeRotationY(MathUtils.degToRad(settings.turn_degrees)))
    .multiply(new Matrix4().makeRotationX(-MathUtils.degToRad(settings.tilt_degrees)));
  const reach = LAMP_DISTANCE * stageRadius(camera, towards.length());
  const preset = PRESETS[settings.preset];
  const filters = [settings.key, settings.fill, settings.rim];
  const lamps = preset.lamps.map(({ kind, towards: way, radiance }, i): Lamp => {
    const direction = new Vector3(...way).normalize().transformDirection(frame);
    return {
      kind, direction, reach, coneDegrees: CONE_DEGREES,
      position: direction.clone().multiplyScalar(reach).add(target),
      radiance: new Vector3(...radiance).multiplyScalar(settings.intensity).multiply(new Vector3(...filters[i]!)),
    };
  });
  const dim = (colour: Rgb): Rgb => colour.map((each, c) => each * settings.ambient * settings.sky[c]!) as Rgb;
  return { lamps, sky: { zenith: dim(preset.sky.zenith), horizon: dim(preset.sky.horizon), ground: dim(preset.sky.ground) } };
}

const basis = ([x, y, z]: Rgb): number[] => [1, y, z, x, x * y, y * z, 3 * z * z - 1, x * z, x * x - y * y];

/** Diffuse light of the sky as nine coefficients of a polynomial of the normal (Ramamoorthi and Hanrahan 2001). */
function skyPolynomial(sky: Sky): Vector3[] {
  const band2 = 0.5 * Math.sqrt(15 / Math.PI);
  const band1 = Math.sqrt(3 / (4 * Math.PI));
  const constants = [0.5 * Math.sqrt(1 / Math.PI), band1, band1, band1, band2, band2, 0.25 * Math.sqrt(5 / Math.PI), band2, 0.5 * band2];
  const side = 64;
  const sums = constants.map(() => [0, 0, 0]);
  for (let i = 0; i < side; ++i) {
    const y = (2 * (i + 0.5)) / side - 1;
    const pole = y > 0 ? sky.zenith : sky.ground;
    const radiance = sky.horizon.map((horizon, c) => horizon + (pole[c]! - horizon) * y * y);
    for (let j = 0; j < side; ++j) {
      const azimuth = (2 * Math.PI * (j + 0.5)) / side;
      const flat = Math.sqrt(1 - y * y);
      const values = basis([flat * Math.sin(azimuth), y, flat * Math.cos(azimuth)]);
      values.forEach((value, k) => radiance.forEach((light, c) => (sums[k]![c]! += light * value)));
    }
  }
  const area = (4 * Math.PI) / (side * side);
  return sums.map((sum, k) => {
    const cosine = k === 0 ? 1 : k < 4 ? 2 / 3 : 0.25; // bands of the clamped cosine, divided by pi
    return new Vector3(...(sum as Rgb)).multiplyScalar(constants[k]! ** 2 * area * cosine);
  });
}

/** A lamp as the shaders take it (struct Light of shaders/common/frame.glsl). */
export function lampVectors({ kind, position, direction, radiance, reach, coneDegrees }: Lamp): { position: Vector4; direction: Vector4; radiance: Vector4 } {
  return {
    position: new Vector4(...position.toArray(), kind === 'directional' ? 0 : 1),
    direction: new Vector4(...direction.toArray(), kind === 'spot' ? Math.cos(MathUtils.degToRad(coneDegrees)) : -1),
    radiance: new Vector4(...radiance.toArray(), reach * reach),
  };
}

/** skyPolynomial() of the last sky, which seldom changes between pictures. */
export class SkyLight {
  private key = '';
  private polynomial: readonly Vector3[] = [];

  of(sky: Sky): readonly Vector3[] {
    const key = JSON.stringify(sky);
    if (key !== this.key) {
      this.key = key;
      this.polynomial = skyPolynomial(sky);
    }
    return this.polynomial;
  }
}
