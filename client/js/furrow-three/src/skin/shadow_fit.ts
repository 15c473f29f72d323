// SPDX-License-Identifier: Apache-2.0
// Fits a lamp's shadow map to what the picture shows: render/scene/shadow_view.h, in three.js's terms.
import { Matrix4, Vector3 } from 'three';
import type { Lamp } from '../view/lighting.js';
import type { ShadowSettings } from '../settings.js';

export interface ShadowView {
  /** World space to the lamp's space, which looks along its -z. */
  view: Matrix4;
  /** To the map's [-1, 1]. */
  scale: number;
  nearPlane: number;
  /** Metres from the near plane to the far one. */
  range: number;
  perspective: boolean;
}

const RESOLUTION_STEP = 128;
const MAX_TANGENT = 1;

function lookAlong(from: Vector3, towards: Vector3): Matrix4 {
  const back = from.clone().sub(towards).normalize();
  const up = Math.abs(back.y) > 0.99 ? new Vector3(0, 0, 1) : new Vector3(0, 1, 0);
  return new Matrix4().lookAt(from, towards, up).setPosition(from).invert();
}

/** Radius in metres around the target that the maps cover. `radius`: of the stage; `distance`: of the camera. */
export function shadedRadius(radius: number, distance: number): number {
  const depth = 0.15; // of a head or a torso
  return Math.hypot(radius * (1 + depth / Math.max(distance, depth)), depth);
}

/** Texels per side that the picture and the filter can show. `pixel`: metres per pixel at the target. */
export function shadowResolution(settings: ShadowSettings, radius: number, pixel: number): number {
  if (!settings.fit) return settings.resolution;
  const filter = settings.filter === 'pcf' ? 0.001 * settings.softness_mm : 0;
  const texel = Math.max(pixel, 0.5 * filter);
  return Math.min(settings.resolution, Math.ceil((2 * radius) / (texel * RESOLUTION_STEP)) * RESOLUTION_STEP);
}

export function fitShadow(lamp: Lamp, centre: Vector3, radius: number, resolution: number): ShadowView {
  if (lamp.kind === 'directional') {
    const texel = (2 * radius) / resolution;
    const turn = lookAlong(new Vector3(), lamp.direction.clone().negate());
    // The centre moves by whole texels, so that shadows do not flicker when the camera moves.
    const there = centre.clone().applyMatrix4(turn);
    const view = new Matrix4()
      .makeTranslation(-Math.floor(there.x / texel) * texel, -Math.floor(there.y / texel) * texel, -(there.z + radius)).multiply(turn);
    return { view, scale: 1 / radius, nearPlane: 0, range: 2 * radius, perspective: false };
  }
  const distance = Math.max(lamp.position.distanceTo(centre), 1e-3);
  const tangent = distance > 1.01 * radius ? radius / Math.sqrt(distance ** 2 - radius ** 2) : MAX_TANGENT;
  const nearPlane = Math.max(distance - radius, 0.01 * distance);
  return {
    view: lookAlong(lamp.position, centre), scale: 1 / Math.min(tangent, MAX_TANGENT), nearPlane,
    range: distance + radius - nearPlane, perspective: true,
  };
}
