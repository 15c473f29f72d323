// SPDX-License-Identifier: Apache-2.0
#include "common/math.glsl"

// NUM_JOINTS  joints of the character's skeleton

// Skinning matrices (placement * model * inverse_bind) of the joints, subject after subject. Each
// is an affine 3x4 matrix in three texels, row by row. A texture rather than a storage buffer: each
// vertex reads other places, which llvmpipe does one by one for buffers.
layout(binding = 15) uniform samplerBuffer u_joint_rows;

struct SkinMatrix {
  vec4 row0;
  vec4 row1;
  vec4 row2;
};

// The matrices of a vertex's joints.
struct JointMatrices {
  SkinMatrix of[4];
};

JointMatrices jointMatrices(uint subject, uvec4 joints) {
  JointMatrices matrices;
  for (int i = 0; i < 4; ++i) {
    int row = int(3u * (subject * uint(NUM_JOINTS) + joints[i]));
    matrices.of[i] = SkinMatrix(texelFetch(u_joint_rows, row), texelFetch(u_joint_rows, row + 1),
                                texelFetch(u_joint_rows, row + 2));
  }
  return matrices;
}

// Linear blend of up to four joints. `skinWeights` sum to 1.
SkinMatrix blendJoints(JointMatrices matrices, vec4 skinWeights) {
  SkinMatrix m = SkinMatrix(vec4(0.0), vec4(0.0), vec4(0.0));
  for (int i = 0; i < 4; ++i) {
    m.row0 += skinWeights[i] * matrices.of[i].row0;
    m.row1 += skinWeights[i] * matrices.of[i].row1;
    m.row2 += skinWeights[i] * matrices.of[i].row2;
  }
  return m;
}

// Transforms a point from the rest pose to the picture's model space, metres.
vec3 skinPoint(SkinMatrix m, vec3 p) {
  vec4 point = vec4(p, 1.0);
  return vec3(dot(m.row0, point), dot(m.row1, point), dot(m.row2, point));
}

// Adds to the tangents of the surface at the rest point `p`, which is posed to `posed`, how far the
// changes of the skin weights move the points beside it (render/mesh/weight_gradients.h).
void addWeightChanges(JointMatrices matrices, vec3 p, vec3 posed, vec4 weightsAlong,
                      vec4 weightsAcross, inout vec3 along, inout vec3 across) {
  for (int i = 0; i < 4; ++i) {
    // Relative to the posed point, so that a motion that all joints share adds nothing.
    vec3 apart = skinPoint(matrices.of[i], p) - posed;
    along += weightsAlong[i] * apart;
    across += weightsAcross[i] * apart;
  }
}

// How far the surface is stretched along its tangents (x: along, y: across `along`): 1 at rest, less
// where it is compressed; [0.4, 2.5]. `turnedAlong` and `turnedAcross`: the tangents as the joints
// alone turn them, which a placement may scale.
vec2 stretchOf(vec3 along, vec3 across, vec3 turnedAlong, vec3 turnedAcross) {
  float first = length(along) / max(length(turnedAlong), 1e-6);
  float area = length(cross(along, across)) / max(length(cross(turnedAlong, turnedAcross)), 1e-9);
  return clamp(vec2(first, area / max(first, 1e-6)), vec2(0.4), vec2(2.5));
}

// The unit normal of a surface with these tangents. `turned`: the normal as the joints alone turn
// it, which counts where skinning folds the surface over, so that no normal flips.
vec3 surfaceNormal(vec3 turned, vec3 along, vec3 across) {
  vec3 surface = normalizeOrZero(cross(along, across));
  vec3 joint = normalizeOrZero(turned);
  return normalizeOrZero(mix(joint, surface, smoothstep(0.0, 0.3, dot(surface, joint))));
}

// Transforms a direction with the matrix itself, which is correct for rotation and uniform scale.
// The result is not unit.
vec3 skinDirection(SkinMatrix m, vec3 d) {
  return vec3(dot(m.row0.xyz, d), dot(m.row1.xyz, d), dot(m.row2.xyz, d));
}
