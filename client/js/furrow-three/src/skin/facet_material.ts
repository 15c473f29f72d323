// SPDX-License-Identifier: Apache-2.0
// The surface of a character without light, for the view 'facets': what shaders/scene/facet_frag.glsl computes, stored by
// shaders/scene/stored_facet.glsl, at the end of a material of three.js.
import type { IUniform } from 'three';
import { glslOf } from './glsl.js';
import { type Kind, KINDS, MAX_CURVATURE } from './materials.js';

/** Attributes and textures that differ between materials. */
export interface FacetUniforms extends Record<string, IUniform> {
  furrowCavityAlbedo: IUniform<number>;
  /** Metres of flesh that light passes through, at least. */
  furrowThickness: IUniform<number>;
}

/** Declarations of the fragment shader. `kind`: of the material. `hasThicknessMap`: there is a `furrowThicknessMap`. */
export function facetHead(kind: Kind, hasThicknessMap: boolean): string {
  return `
varying vec3 vFurrowWorld;
uniform vec3 furrowForward;         // the camera's direction, unit, world space
uniform vec3 furrowGloss;           // x: scale of m, y: 1: m grows by the variance of the slopes
uniform float furrowCavityAlbedo;
uniform float furrowThickness;
${hasThicknessMap ? 'uniform sampler2D furrowThicknessMap;' : ''}
float furrowOpen = 1.0;
layout(location = 1) out highp vec4 furrowNormalOut;
layout(location = 2) out highp vec4 furrowGeometricOut;
layout(location = 3) out highp vec4 furrowMatterOut;
layout(location = 4) out highp float furrowDepthOut;
layout(location = 5) out highp vec4 furrowEmissionOut;
vec3 normalizeOrZero(vec3 v) { return furrowUnit(v); }
${glslOf('scene/stored_facet.glsl', { MAX_CURVATURE })}
const int FURROW_KIND = ${KINDS.indexOf(kind)};
`;
}

/** Before wrinkles change the base colour. Real skin reflects at least 2%; a darker colour marks a painted hollow. */
export const FACET_OPEN = 'if (furrowCavityAlbedo > 0.0) furrowOpen = clamp(diffuseColor.g / furrowCavityAlbedo, 0.0, 1.0);\n';

/** The last statements of the fragment shader. `oneNormal`: both sides have the same normals. */
export function facetTail(oneNormal: boolean, hasThicknessMap: boolean): string {
  return `
{
  vec3 furrowSide = ${oneNormal ? 'vNormal' : 'gl_FrontFacing ? vNormal : -vNormal'};
  vec3 furrowGeometric = inverseTransformDirection(furrowUnit(furrowSide), viewMatrix);
  float furrowM = furrowGloss.x * roughnessFactor * roughnessFactor;
  if (furrowGloss.y > 0.5) furrowM = sqrt(furrowM * furrowM + 2.0 * furrowVariance);
  float furrowThick = furrowThickness${hasThicknessMap ? ' * texture2D(furrowThicknessMap, vMapUv).g' : ''};
  StoredFacet furrowStored = storeFacet(Facet(FURROW_KIND, vFurrowWorld, diffuseColor.rgb, inverseTransformDirection(normal, viewMatrix),
    furrowGeometric, clamp(furrowM, SMALLEST_M, 1.0), 0.0, furrowThick, furrowOpen, furrowFactors.a, vec3(0.0)));
  gl_FragColor = furrowStored.colour;
  furrowNormalOut = furrowStored.normal;
  furrowGeometricOut = furrowStored.geometric;
  furrowMatterOut = furrowStored.matter;
  furrowDepthOut = dot(vFurrowWorld - cameraPosition, furrowForward);
  furrowEmissionOut = vec4(totalEmissiveRadiance, 0.0);
}
`;
}

/** A shade darkens what the targets hold: every output is a factor (shaders/scene/shade.frag.glsl). */
export const SHADE_HEAD = `
layout(location = 1) out highp vec4 furrowNormalOut;
layout(location = 2) out highp vec4 furrowGeometricOut;
layout(location = 3) out highp vec4 furrowMatterOut;
layout(location = 4) out highp float furrowDepthOut;
layout(location = 5) out highp vec4 furrowEmissionOut;
`;

export const SHADE_TAIL = `
gl_FragColor = vec4(sqrt(diffuseColor.rgb), 1.0);
furrowNormalOut = vec4(1.0);
furrowGeometricOut = vec4(vec3(1.0), dot(diffuseColor.rgb, vec3(0.2126, 0.7152, 0.0722)));
furrowMatterOut = vec4(1.0);
furrowDepthOut = 1.0;
furrowEmissionOut = vec4(diffuseColor.rgb, 1.0);
`;
