// SPDX-License-Identifier: Apache-2.0
// The light of the daemon's default picture, for the view 'studio': a warm key, a cool fill and a rim around the camera, and
// a sky. No shadows and no subsurface scattering, as the daemon's
// shading "diffuse".
import { Color, type PerspectiveCamera, Vector3, Vector4 } from 'three';
import { lampVectors, makeLighting, SkyLight } from './lighting.js';
import { defaultSettings, type LightSettings } from '../settings.js';

/** The daemon's default background, linear. */
export const STUDIO_BACKGROUND = new Color().setRGB(...defaultSettings().background, 'srgb-linear');

/** GLSL of shaders/scene/lighting.glsl, shaders/common/frame.glsl and shaders/post/tonemap.glsl. */
export const STUDIO_GLSL = `
varying vec3 vFurrowWorld;
uniform vec4 furrowLampPositions[3];   // w: 0: directional
uniform vec4 furrowLampDirections[3];  // towards the lamp; w: cosine at a spot's edge, -1: no spot
uniform vec4 furrowLampRadiances[3];   // w: squared distance for which rgb is given
uniform vec3 furrowSky[9];
uniform float furrowSpecular;
uniform float furrowCavityAlbedo;

vec3 furrowSkyIrradiance(vec3 n) {
  return max(furrowSky[0] + n.y * furrowSky[1] + n.z * furrowSky[2] + n.x * furrowSky[3] + n.x * n.y * furrowSky[4] +
    n.y * n.z * furrowSky[5] + (3.0 * n.z * n.z - 1.0) * furrowSky[6] + n.x * n.z * furrowSky[7] +
    (n.x * n.x - n.y * n.y) * furrowSky[8], vec3(0.0));
}
vec3 furrowStudio(vec3 albedo, vec3 normal, float rough) {
  float alpha = max(rough * rough, 0.04);
  float exponent = max(2.0 / (alpha * alpha) - 2.0, 1.0);
  float open = furrowCavityAlbedo > 0.0 ? clamp(albedo.g / furrowCavityAlbedo, 0.0, 1.0) : 1.0;
  vec3 toCamera = normalize(cameraPosition - vFurrowWorld);
  vec3 diffuseLight = furrowSkyIrradiance(normal);
  vec3 specularLight = vec3(0.0);
  for (int i = 0; i < 3; ++i) {
    vec4 position = furrowLampPositions[i];
    vec4 direction = furrowLampDirections[i];
    vec3 towards = position.xyz - vFurrowWorld;
    float distance2 = max(dot(towards, towards), 1e-6);
    vec3 toLight = position.w > 0.5 ? towards * inversesqrt(distance2) : direction.xyz;
    float falloff = position.w > 0.5 ? furrowLampRadiances[i].w / distance2 : 1.0;
    float cone = direction.w > -1.0 ? smoothstep(direction.w, mix(direction.w, 1.0, 0.25), dot(toLight, direction.xyz)) : 1.0;
    vec3 irradiance = furrowLampRadiances[i].rgb * falloff * cone * clamp(dot(normal, toLight), 0.0, 1.0);
    diffuseLight += irradiance;
    vec3 h = furrowUnit(toLight + toCamera);
    float grazing = 1.0 - clamp(dot(h, toCamera), 0.0, 1.0);
    float fresnel = 1.0 + 24.0 * grazing * grazing * grazing * grazing * grazing;
    float lobe = pow(max(dot(normal, h), 1e-4), exponent);
    specularLight += irradiance * furrowSpecular * open * fresnel * (exponent + 8.0) * 0.125 * lobe;
  }
  vec3 colour = albedo * diffuseLight + specularLight;
  // Khronos PBR Neutral without its toe.
  float peak = max(colour.r, max(colour.g, colour.b));
  float d = 1.0 - 0.76;
  float newPeak = 1.0 - d * d / (peak + d - 0.76);
  float g = 1.0 - 1.0 / (0.15 * (peak - newPeak) + 1.0);
  return peak < 0.76 ? colour : mix(colour * (newPeak / peak), vec3(newPeak), g);
}
`;

/** The uniforms of all materials of a character. update() places the lamps for a picture. */
export class Studio {
  readonly uniforms = {
    furrowLampPositions: { value: [0, 1, 2].map(() => new Vector4()) },
    furrowLampDirections: { value: [0, 1, 2].map(() => new Vector4()) },
    furrowLampRadiances: { value: [0, 1, 2].map(() => new Vector4()) },
    furrowSky: { value: Array.from({ length: 9 }, () => new Vector3()) },
  };
  private readonly skyLight = new SkyLight();

  /** The lamps turn with the camera, so that every view is lit alike. `target`: what the camera looks at. */
  update(camera: PerspectiveCamera, target: Vector3, settings: LightSettings = defaultSettings().lights): void {
    const { lamps, sky } = makeLighting(settings, camera, target);
    lamps.map(lampVectors).forEach(({ position, direction, radiance }, i) => {
      this.uniforms.furrowLampPositions.value[i]!.copy(position);
      this.uniforms.furrowLampDirections.value[i]!.copy(direction);
      this.uniforms.furrowLampRadiances.value[i]!.copy(radiance);
    });
    this.skyLight.of(sky).forEach((each, i) => this.uniforms.furrowSky.value[i]!.copy(each));
  }
}
