// SPDX-License-Identifier: Apache-2.0
// The light of the daemon's default picture, for the view 'studio': a warm key, a cool fill and a rim around the camera, and
// a sky (render/scene/lighting.cpp, render/scene/sky_light.cpp). No shadows and no subsurface scattering, as the daemon's
// shading "diffuse".
import { Color, Matrix4, type PerspectiveCamera, Vector2, Vector3, Vector4 } from 'three';

interface Lamp {
  /** In the camera's frame: x to the right, y up, z towards the camera. */
  towards: readonly [number, number, number];
  /** Linear radiance that a white surface facing the lamp reflects. */
  radiance: readonly [number, number, number];
  kind: 'spot' | 'point' | 'directional';
}

const LAMPS: readonly Lamp[] = [
  { towards: [-0.78, 0.72, 0.76], radiance: [1.12, 0.98, 0.84], kind: 'spot' },
  { towards: [0.84, 0.46, 0.52], radiance: [0.22, 0.225, 0.25], kind: 'point' },
  { towards: [0.58, 0.25, -1.05], radiance: [0.28, 0.31, 0.36], kind: 'directional' },
];
const CONE_DEGREES = 24;
/** Distance of spots and points from the target, in radii of the stage. */
const LAMP_DISTANCE = 7;
const SKY = { zenith: [0.15, 0.155, 0.165], horizon: [0.08, 0.078, 0.078], ground: [0.045, 0.038, 0.034] } as const;

/** The daemon's default background, linear. */
export const STUDIO_BACKGROUND = new Color().setRGB(0.028, 0.029, 0.031, 'srgb-linear');

const basis = ([x, y, z]: readonly [number, number, number]): number[] =>
  [1, y, z, x, x * y, y * z, 3 * z * z - 1, x * z, x * x - y * y];

/** Diffuse light of the sky as a polynomial of the normal (Ramamoorthi and Hanrahan 2001). */
function skyPolynomial(): Vector3[] {
  const band2 = 0.5 * Math.sqrt(15 / Math.PI);
  const band1 = Math.sqrt(3 / (4 * Math.PI));
  const constants = [0.5 * Math.sqrt(1 / Math.PI), band1, band1, band1, band2, band2, 0.25 * Math.sqrt(5 / Math.PI), band2, 0.5 * band2];
  const side = 64;
  const sums = constants.map(() => [0, 0, 0]);
  for (let i = 0; i < side; ++i) {
    const y = (2 * (i + 0.5)) / side - 1;
    const pole = y > 0 ? SKY.zenith : SKY.ground;
    const radiance = SKY.horizon.map((horizon, c) => horizon + (pole[c]! - horizon) * y * y);
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
    return new Vector3(...(sum as [number, number, number])).multiplyScalar(constants[k]! ** 2 * area * cosine);
  });
}

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
    furrowLampPositions: { value: LAMPS.map(() => new Vector4()) },
    furrowLampDirections: { value: LAMPS.map(() => new Vector4()) },
    furrowLampRadiances: { value: LAMPS.map(() => new Vector4()) },
    furrowSky: { value: skyPolynomial() },
  };

  /** The lamps turn with the camera, so that every view is lit alike. `target`: what the camera looks at. */
  update(camera: PerspectiveCamera, target: Vector3): void {
    const towards = target.clone().sub(camera.position);
    const distance = towards.length();
    const heading = new Matrix4().makeRotationY(Math.atan2(-towards.x, -towards.z));
    const half = Math.tan((camera.fov * Math.PI) / 360);
    const reach = LAMP_DISTANCE * 1.15 * distance * half * new Vector2(camera.aspect, 1).length();
    LAMPS.forEach(({ towards: way, radiance, kind }, i) => {
      const direction = new Vector3(...way).normalize().applyMatrix4(heading);
      const position = direction.clone().multiplyScalar(reach).add(target);
      this.uniforms.furrowLampPositions.value[i]!.set(position.x, position.y, position.z, kind === 'directional' ? 0 : 1);
      this.uniforms.furrowLampDirections.value[i]!.set(direction.x, direction.y, direction.z,
        kind === 'spot' ? Math.cos((CONE_DEGREES * Math.PI) / 180) : -1);
      this.uniforms.furrowLampRadiances.value[i]!.set(...radiance, reach * reach);
    });
  }
}
