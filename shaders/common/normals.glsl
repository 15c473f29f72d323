// SPDX-License-Identifier: Apache-2.0
#include "common/math.glsl"

// Tangent-space normals as partial derivatives. A derivative is n.xy / n.z of the unit normal n;
// for a height field h(x, y) it is -grad h. x runs along the tangent (u), y along the bitangent,
// which points up in the picture (-v). This is glTF's convention: green above 0.5 leans upwards.

// Unit tangent-space normal of a derivative of any size.
vec3 normalFromDerivative(vec2 derivative) {
  return normalize(vec3(derivative, 1.0));
}

// The derivative on a posed surface of one at rest. `tangent`: its length is the stretch along x,
// and that of its w the stretch along y (scene/pose.vert.glsl). Heights stay while the surface
// deforms, so pores and folds flatten across a stretch and steepen across a compression, as measured
// (Nagano et al. 2015, "Skin Microstructure Deformation with Displacement Map Convolution").
// Interpolation shortens the tangent between vertices, so a compression below 4% does not count.
vec2 stretchedSlope(vec2 derivative, vec4 tangent) {
  float along = length(tangent.xyz);
  along += clamp(1.0 - along, 0.0, 0.04);
  return derivative / vec2(along, abs(tangent.w));
}

// Transforms the tangent-space normal `n` to model space. Returns a unit vector, or 0 if skinning
// left no direction. `normal` and `tangent` need not be unit; the sign of tangent.w is glTF's
// handedness.
vec3 tangentToModel(vec3 n, vec3 normal, vec4 tangent) {
  vec3 unitNormal = normalizeOrZero(normal);
  vec3 t = normalizeOrZero(tangent.xyz - unitNormal * dot(unitNormal, tangent.xyz));
  vec3 b = cross(unitNormal, t) * sign(tangent.w);
  return normalizeOrZero(t * n.x + b * n.y + unitNormal * n.z);
}
