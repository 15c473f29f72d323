// SPDX-License-Identifier: Apache-2.0
// Adds wrinkles to a material of three.js: shaders/wrinkles/wrinkles.glsl and shaders/scene/skinning.glsl, as changes to
// three's own shaders, so that lights, shadows and environment maps work as usual.
import type { IUniform, MeshStandardMaterial, Texture, Vector4, WebGLProgramParametersWithUniforms } from 'three';
import { FACET_OPEN, facetHead, facetTail, SHADE_HEAD, SHADE_TAIL } from '../skin/facet_material.js';
import type { Kind } from '../skin/materials.js';
import { STUDIO_GLSL } from '../view/studio.js';

/** Textures of one wrinkle map; null: it has none. */
export interface WrinkleTextures {
  /** Its layer of `slopes`. */
  slope: number | null;
  amplitude: number;
  /** sRGB, decoded; multiplied by `colourScale`. */
  colour: Texture | null;
  colourScale: number;
  /** Its red channel. */
  cavity: Texture | null;
}

export interface WrinkleInput {
  /** Slopes of the material's own normal map; null: it has none. */
  base: Texture | null;
  masks: Texture[];
  /** The slopes of all maps, in layers (SlopeMaker); null: no map has any. */
  slopes: Texture | null;
  maps: WrinkleTextures[];
  /** Row `map * masks.length + mask`; changed every frame by the caller. */
  weights: Vector4[];
  /** The geometry has the attributes of addWeightGradients(). */
  gradients: boolean;
  /** Uniforms of the view 'studio': those of Studio, `furrowSpecular` and `furrowCavityAlbedo`. */
  studio?: Record<string, IUniform>;
  /** What the view 'facets' needs besides. */
  facets?: FacetInput;
  /** Both sides of the surface have the same normals, as hair has. */
  oneNormal: boolean;
}

export interface FacetInput {
  kind: Kind;
  /** Of all characters and of the material. */
  uniforms: Record<string, IUniform>;
}

/**
 * 'studio': the light of the daemon's default picture, without the scene's lights (Studio).
 * 'normal': 0.5 n + 0.5 of the shading normal in world space, as `furrow render --view normal`.
 * 'facets': the surface without light in several targets, which StudioView lights.
 */
export type View = 'final' | 'studio' | 'normal' | 'facets';

const VERTEX_HEAD = `
varying vec2 vFurrowUv;
varying vec4 vFurrowTangent;
#ifdef FURROW_WORLD
varying vec3 vFurrowWorld;
#endif
#ifdef FURROW_GRADIENTS
varying vec2 vFurrowStretch;
attribute vec4 furrowAlong;
attribute vec4 furrowAcross;
vec3 furrowUnit(vec3 v) { return v * inversesqrt(max(dot(v, v), 1e-24)); }
void furrowAddChange(mat4 bone, vec3 rest, vec3 posed, float along, float across, inout vec3 x, inout vec3 y) {
  // Relative to the posed point, so that a motion that all joints share adds nothing.
  vec3 apart = (bone * vec4(rest, 1.0)).xyz - posed;
  x += along * apart;
  y += across * apart;
}
#endif
`;

/** Replaces the normal and the tangent, in three's object space, after three has skinned them. */
const VERTEX_GRADIENTS = `
#ifdef FURROW_GRADIENTS
{
  vec3 furrowRest = position;
  vec3 furrowNormal = normal;
  vec3 furrowTangent = tangent.xyz;
  #ifdef USE_MORPHTARGETS
    for (int i = 0; i < MORPHTARGETS_COUNT; i++) {
      if (morphTargetInfluences[i] != 0.0) furrowRest += getMorph(gl_VertexID, i, 0).xyz * morphTargetInfluences[i];
    }
    #ifdef USE_MORPHNORMALS
    for (int i = 0; i < MORPHTARGETS_COUNT; i++) {
      if (morphTargetInfluences[i] != 0.0) furrowNormal += getMorph(gl_VertexID, i, 1).xyz * morphTargetInfluences[i];
    }
    furrowNormal = furrowUnit(furrowNormal);
    #endif
  #endif
  mat4 furrowSkin = skinWeight.x * boneMatX + skinWeight.y * boneMatY + skinWeight.z * boneMatZ + skinWeight.w * boneMatW;
  vec3 furrowPosed = (furrowSkin * vec4(furrowRest, 1.0)).xyz;
  vec3 furrowTurned = furrowUnit((furrowSkin * vec4(furrowNormal, 0.0)).xyz);
  vec3 restAcross = furrowUnit(cross(furrowNormal, furrowTangent));
  vec3 y = (furrowSkin * vec4(restAcross, 0.0)).xyz;
  vec3 x = (furrowSkin * vec4(furrowUnit(cross(restAcross, furrowNormal)), 0.0)).xyz;
  vec3 turnedX = x;
  vec3 turnedY = y;
  furrowAddChange(boneMatX, furrowRest, furrowPosed, furrowAlong.x, furrowAcross.x, x, y);
  furrowAddChange(boneMatY, furrowRest, furrowPosed, furrowAlong.y, furrowAcross.y, x, y);
  furrowAddChange(boneMatZ, furrowRest, furrowPosed, furrowAlong.z, furrowAcross.z, x, y);
  furrowAddChange(boneMatW, furrowRest, furrowPosed, furrowAlong.w, furrowAcross.w, x, y);
  // The normal as the joints alone turn it counts where skinning folds the surface over.
  vec3 furrowSurface = furrowUnit(cross(x, y));
  objectNormal = furrowUnit(mix(furrowTurned, furrowSurface, smoothstep(0.0, 0.3, dot(furrowSurface, furrowTurned))));
  objectTangent = x;
  // How far the surface is stretched along and across its tangent (stretchOf() of shaders/scene/skinning.glsl).
  float along = length(x) / max(length(turnedX), 1e-6);
  float area = length(cross(x, y)) / max(length(cross(turnedX, turnedY)), 1e-9);
  vFurrowStretch = clamp(vec2(along, area / max(along, 1e-6)), vec2(0.4), vec2(2.5));
}
#endif
`;

/**
 * The share of a pixel's samples that a cut-out keeps (samplesLeft() of shaders/scene/surface_frag.glsl). Where texels
 * are larger than pixels, the edge through the pixel determines it. Where a pixel covers many, their mean alpha does, so
 * that lashes do not vanish.
 */
const ALPHA_TEST = `
#if defined(USE_ALPHATEST) && defined(ALPHA_TO_COVERAGE) && defined(USE_MAP)
{
  vec2 texels = vMapUv * vec2(textureSize(map, 0));
  vec2 along = dFdx(texels);
  vec2 across = dFdy(texels);
  float level = 0.5 * log2(max(dot(along, along), dot(across, across)));
  float line = clamp((diffuseColor.a - alphaTest) / max(fwidth(diffuseColor.a), 1e-4) + 0.5, 0.0, 1.0);
  diffuseColor.a = mix(line, diffuseColor.a, clamp(level, 0.0, 1.0));
  if (diffuseColor.a == 0.0) discard;
}
#else
#include <alphatest_fragment>
#endif
`;

/** Pores and folds flatten along a stretch and steepen along a compression (stretchedSlope() of shaders/common/normals.glsl). */
const STRETCHED = 'p /= vec2(vFurrowStretch.x + clamp(1.0 - vFurrowStretch.x, 0.0, 0.04), vFurrowStretch.y);';

const slopeAt = (layer: number): string => `texture(furrowSlopes, vec3(vFurrowUv, ${layer}.0))`;

/** `moments`: slope textures hold squares, too, which give the variance of the slopes within a pixel. */
function tangentNormal({ base, maps, gradients }: WrinkleInput, moments: boolean): string[] {
  const stretched = gradients ? [`  ${STRETCHED}`] : [];
  if (!moments) {
    // Partial derivatives: p = p_base + sum w_i p_i. Heights add up, so the sum is exact.
    const lines = ['vec3 furrowTangentNormal(vec2 baseUv) {', `  vec2 p = ${base ? 'texture2D(furrowBase, baseUv).xy' : 'vec2(0.0)'};`];
    maps.forEach(({ slope, amplitude }, i) => {
      if (slope !== null) lines.push(`  p += furrowCoefficient[${i}] * ${amplitude.toFixed(6)} * ${slopeAt(slope)}.xy;`);
    });
    return [...lines, ...stretched, '  return normalize(vec3(p, 1.0));', '}'];
  }
  const lines = [
    'float furrowVariance = 0.0;',
    // shaders/wrinkles/wrinkles_frag.glsl: the maps are assumed to be independent, so variances add up.
    'void furrowAddSlope(vec4 moments, float w, inout vec2 p) {',
    '  vec2 variance = max(moments.ba - moments.rg * moments.rg, vec2(0.0));',
    '  p += w * moments.rg;',
    '  furrowVariance += w * w * 0.5 * (variance.x + variance.y);',
    '}',
    'vec3 furrowTangentNormal(vec2 baseUv) {', '  vec2 p = vec2(0.0);',
    ...(base ? ['  furrowAddSlope(texture2D(furrowBase, baseUv), 1.0, p);'] : []),
  ];
  maps.forEach(({ slope, amplitude }, i) => {
    if (slope !== null) lines.push(`  furrowAddSlope(${slopeAt(slope)}, furrowCoefficient[${i}] * furrowShown.y * ${amplitude.toFixed(6)}, p);`);
  });
  return [...lines, ...stretched, '  return normalize(vec3(p, 1.0));', '}'];
}

function fragmentHead(input: WrinkleInput, view: View): string {
  const { masks, maps } = input;
  const lines = ['varying vec2 vFurrowUv;', 'varying vec4 vFurrowTangent;', 'vec3 furrowWorldNormal;'];
  if (input.gradients) lines.push('varying vec2 vFurrowStretch;');
  // Strength of all wrinkles (x), their slopes (y), colours (z) and cavities (w).
  if (view === 'facets') lines.push('uniform vec4 furrowShown;');
  const strength = view === 'facets' ? { all: 'furrowShown.x * ', colour: ' * furrowShown.z', cavity: ' * furrowShown.w' } : { all: '', colour: '', cavity: '' };
  if (input.base) lines.push('uniform sampler2D furrowBase;');
  masks.forEach((_, i) => lines.push(`uniform sampler2D furrowMask${i};`));
  if (input.slopes) lines.push('uniform highp sampler2DArray furrowSlopes;');
  maps.forEach(({ colour, cavity }, i) => {
    if (colour) lines.push(`uniform sampler2D furrowColour${i};`);
    if (cavity) lines.push(`uniform sampler2D furrowCavity${i};`);
  });
  if (maps.length > 0) {
    lines.push(`uniform vec4 furrowWeights[${maps.length * masks.length}];`, `float furrowCoefficient[${maps.length}];`);
  }
  // Coefficient of each map: the sum of weight * mask over its regions.
  lines.push('void furrowReadMasks() {');
  if (maps.length > 0) {
    masks.forEach((_, i) => lines.push(`  vec4 mask${i} = texture2D(furrowMask${i}, vFurrowUv);`));
    maps.forEach((_, map) => lines.push(`  furrowCoefficient[${map}] = ${strength.all}(${masks.map((__, i) =>
      `dot(furrowWeights[${map * masks.length + i}], mask${i})`).join(' + ')});`));
  }
  lines.push('}');
  lines.push(...tangentNormal(input, view === 'facets'));
  // Factors of the base colour (rgb) and of the incoming light (a).
  lines.push('vec4 furrowLook() {', '  vec4 look = vec4(1.0);');
  maps.forEach(({ colour, colourScale, cavity }, i) => {
    if (colour) {
      lines.push(`  look.rgb *= max(mix(vec3(1.0), texture2D(furrowColour${i}, vFurrowUv).rgb * ${colourScale.toFixed(6)}, furrowCoefficient[${i}]${strength.colour}), vec3(0.0));`);
    }
    if (cavity) lines.push(`  look.a *= max(mix(1.0, texture2D(furrowCavity${i}, vFurrowUv).r, furrowCoefficient[${i}]${strength.cavity}), 0.0);`);
  });
  lines.push('  return look;', '}');
  lines.push(`
vec3 furrowUnit(vec3 v) { return v * inversesqrt(max(dot(v, v), 1e-24)); }
vec3 furrowViewNormal(vec3 n, vec3 geometric, vec4 tangent) {
  vec3 unitNormal = furrowUnit(geometric);
  vec3 t = furrowUnit(tangent.xyz - unitNormal * dot(unitNormal, tangent.xyz));
  vec3 b = cross(unitNormal, t) * tangent.w;
  return furrowUnit(t * n.x + b * n.y + unitNormal * n.z);
}`);
  return `${lines.join('\n')}\n`;
}

function replace(shader: string, what: string, by: string): string {
  if (!shader.includes(what)) throw new Error(`furrow-three: this version of three.js has no ${what}`);
  return shader.replace(what, () => by);
}

function addUniforms(uniforms: Record<string, IUniform>, input: WrinkleInput): void {
  if (input.base) uniforms.furrowBase = { value: input.base };
  input.masks.forEach((mask, i) => {
    uniforms[`furrowMask${i}`] = { value: mask };
  });
  if (input.slopes) uniforms.furrowSlopes = { value: input.slopes };
  input.maps.forEach(({ colour, cavity }, i) => {
    if (colour) uniforms[`furrowColour${i}`] = { value: colour };
    if (cavity) uniforms[`furrowCavity${i}`] = { value: cavity };
  });
  if (input.maps.length > 0) uniforms.furrowWeights = { value: input.weights };
}

function patchVertex(shader: WebGLProgramParametersWithUniforms): void {
  let source = replace(shader.vertexShader, '#include <common>', `#include <common>\n${VERTEX_HEAD}`);
  source = replace(source, '#include <skinnormal_vertex>', `#include <skinnormal_vertex>\n${VERTEX_GRADIENTS}`);
  source = replace(source, '#include <begin_vertex>',
    'vFurrowUv = uv;\nvFurrowTangent = vec4(transformedTangent, tangent.w);\n#include <begin_vertex>');
  source = replace(source, '#include <project_vertex>',
    '#include <project_vertex>\n#ifdef FURROW_WORLD\nvFurrowWorld = (modelMatrix * vec4(transformed, 1.0)).xyz;\n#endif\n');
  shader.vertexShader = source;
}

function patchFragment(shader: WebGLProgramParametersWithUniforms, input: WrinkleInput, view: View): void {
  const { facets } = input;
  const shade = facets?.kind === 'shade';
  const hasThicknessMap = facets?.uniforms.furrowThicknessMap !== undefined;
  let head = fragmentHead(input, view);
  if (view === 'studio') head += STUDIO_GLSL;
  if (view === 'facets' && facets) head += shade ? SHADE_HEAD : facetHead(facets.kind, hasThicknessMap);
  let source = replace(shader.fragmentShader, '#include <common>', `#include <common>\n${head}`);
  // The daemon's shading "diffuse" has no colours and cavities of wrinkle maps.
  const open = view === 'facets' && !shade ? FACET_OPEN : '';
  source = replace(source, '#include <map_fragment>', '#include <map_fragment>\nfurrowReadMasks();\n' + open +
    (view === 'studio' ? 'vec4 furrowFactors = vec4(1.0);\n' : 'vec4 furrowFactors = furrowLook();\ndiffuseColor.rgb *= furrowFactors.rgb;\n'));
  // The facets have one sample per pixel, so the edge of a cut-out is where its alpha is too low.
  if (view !== 'facets') source = replace(source, '#include <alphatest_fragment>', ALPHA_TEST);
  const baseUv = input.base ? 'vNormalMapUv' : 'vec2(0.0)';
  // Three turns `normal` for double-sided materials before this point; the tangent frame here starts from the surface's side.
  const facing = input.oneNormal ? '' : '#ifdef DOUBLE_SIDED\nnormal *= faceDirection;\n#endif\n';
  source = replace(source, '#include <normal_fragment_maps>',
    `normal = furrowViewNormal(furrowTangentNormal(${baseUv}), vNormal, vFurrowTangent);\n${facing}`);
  // Folds shut out part of the light that comes from everywhere, as an occlusion map does.
  source = replace(source, '#include <aomap_fragment>',
    '#include <aomap_fragment>\nreflectedLight.indirectDiffuse *= furrowFactors.a;\nreflectedLight.directSpecular *= furrowFactors.a;\n' +
    'reflectedLight.indirectSpecular *= furrowFactors.a;');
  // A shade is what three multiplies the picture by, whatever the light.
  if (shade && view !== 'facets') source = replace(source, '#include <opaque_fragment>', 'gl_FragColor = vec4(diffuseColor.rgb, 1.0);');
  else if (view === 'studio') {
    source = replace(source, '#include <opaque_fragment>',
      'outgoingLight = furrowStudio(diffuseColor.rgb, inverseTransformDirection(normal, viewMatrix), roughnessFactor) + totalEmissiveRadiance;\n#include <opaque_fragment>');
  }
  const last = (code: string): void => {
    source = replace(source, '#include <dithering_fragment>', `#include <dithering_fragment>\n${code}`);
  };
  if (view === 'normal') last('gl_FragColor = vec4(inverseTransformDirection(normal, viewMatrix) * 0.5 + 0.5, gl_FragColor.a);');
  if (view === 'facets' && facets) last(shade ? SHADE_TAIL : facetTail(input.oneNormal, hasThicknessMap));
  shader.fragmentShader = source;
}

/**
 * Makes `material` draw wrinkles. Its geometry needs tangents. `material.normalMap` must be set if `input.base` is, for
 * its UVs; its texels are not read.
 */
export function addWrinkles(material: MeshStandardMaterial, input: WrinkleInput, view: View): void {
  const defined = material as { defines?: Record<string, unknown> };
  const { FURROW_WORLD: _, ...others } = defined.defines ?? {};
  const world = view === 'studio' || view === 'facets';
  defined.defines = {
    ...others, USE_TANGENT: '', ...(input.gradients ? { FURROW_GRADIENTS: '' } : {}), ...(world ? { FURROW_WORLD: '' } : {}),
  };
  material.onBeforeCompile = (shader) => {
    addUniforms(shader.uniforms, input);
    if (view === 'studio') Object.assign(shader.uniforms, input.studio);
    if (view === 'facets') Object.assign(shader.uniforms, input.facets?.uniforms);
    patchVertex(shader);
    patchFragment(shader, input, view);
  };
  const key = JSON.stringify([view, input.masks.length, input.base !== null, input.oneNormal, input.gradients,
    input.facets?.kind, input.facets?.uniforms.furrowThicknessMap !== undefined,
    input.maps.map(({ slope, colour, cavity, amplitude, colourScale }) => [slope, !colour, !cavity, amplitude, colourScale])]);
  material.customProgramCacheKey = () => `furrow ${key}`;
  material.needsUpdate = true;
}
