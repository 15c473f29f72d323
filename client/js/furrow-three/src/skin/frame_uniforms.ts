// SPDX-License-Identifier: Apache-2.0
// The values that are constant within a picture: the uniform block of shaders/common/frame.glsl, as
// render/scene/frame_block.h fills it.
import { Matrix3, type Matrix4, type PerspectiveCamera, Vector3, Vector4 } from 'three';
import { lampVectors, type Lighting, makeLighting, SkyLight, stageRadius } from '../view/lighting.js';
import type { StudioSettings } from '../settings.js';
import { fitShadow, shadedRadius, shadowResolution, type ShadowView } from './shadow_fit.js';

/** Struct Light of the shader. */
export interface LightUniform {
  position: Vector4;
  direction: Vector4;
  radiance: Vector4;
  shadow_view: Matrix4;
  shadow: Vector4;
}

export interface PictureFrame {
  width: number;
  height: number;
  /** Metres from the camera to its target. */
  focusDistance: number;
  /** Pixels per unit of y / -z in view space. */
  pixelsPerSlope: number;
  forward: Vector3;
  viewRotation: Matrix3;
  lighting: Lighting;
  shadows: ShadowView[];
  /** Texels per side of a shadow map. */
  shadowTexels: number;
}

/** The camera's matrices must be up to date. `target`: what it looks at. */
export function pictureFrame(camera: PerspectiveCamera, target: Vector3, settings: StudioSettings, width: number, height: number): PictureFrame {
  const towards = target.clone().sub(camera.position);
  const focusDistance = towards.length();
  const pixelsPerSlope = (0.5 * height) / Math.tan((camera.fov * Math.PI) / 360);
  const lighting = makeLighting(settings.lights, camera, target);
  const shaded = shadedRadius(stageRadius(camera, focusDistance), focusDistance);
  const shadowTexels = shadowResolution(settings.shadow, shaded, focusDistance / pixelsPerSlope);
  return {
    width, height, focusDistance, pixelsPerSlope, lighting, shadowTexels,
    forward: towards.normalize(),
    viewRotation: new Matrix3().setFromMatrix4(camera.matrixWorldInverse),
    shadows: lighting.lamps.map((lamp) => fitShadow(lamp, target, shaded, shadowTexels)),
  };
}

const PER_MM = 0.001;

export class FrameUniforms {
  private readonly skyLight = new SkyLight();

  /** Uniforms by name. */
  of(frame: PictureFrame, camera: PerspectiveCamera, settings: StudioSettings): Record<string, unknown> {
    const { lighting: { lamps, sky }, shadows } = frame;
    const { shadow, specular, subsurface, translucency, wrinkle_maps: maps } = settings;
    const u_lights = lamps.map((lamp, i): LightUniform => ({
      ...lampVectors(lamp),
      shadow_view: shadows[i]!.view,
      shadow: new Vector4(shadows[i]!.scale, shadows[i]!.nearPlane, 1 / shadows[i]!.range, shadows[i]!.perspective ? 1 : 0),
    }));
    return {
      u_lights,
      u_camera_position: new Vector4(...camera.position.toArray(), 1),
      u_camera_forward: new Vector4(...frame.forward.toArray(), frame.focusDistance),
      u_ambient: this.skyLight.of(sky).map(({ x, y, z }) => new Vector4(x, y, z, 0)),
      u_sky_zenith: new Vector4(...sky.zenith, 0),
      u_sky_horizon: new Vector4(...sky.horizon, 0),
      u_sky_ground: new Vector4(...sky.ground, 0),
      u_shadow_filter: new Vector4(shadow.softness_mm * PER_MM, shadow.lamp_mm * PER_MM, shadow.normal_offset_mm * PER_MM, frame.shadowTexels),
      u_gloss: new Vector4(specular.strength, specular.roughness, specular.second_lobe, subsurface.mix),
      u_translucency: new Vector4(translucency.enabled ? translucency.strength : 0, translucency.scale, translucency.shrink_mm * PER_MM, subsurface.strength),
      u_wrinkle_maps: new Vector4(maps.blood_flow, maps.cavity, 0, 0),
    };
  }
}
