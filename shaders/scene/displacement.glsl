// SPDX-License-Identifier: Apache-2.0
#include "common/frame.glsl"
#include "wrinkles/masks.glsl"
#include "common/math.glsl"

// A corner or edge end of a patch, passed from tessellation control to evaluation. Edges and
// corners have owners, and all adjacent patches use the owner's position, normal and UV
// (render/mesh/displacement_patches.h). Equal inputs and an equal order of operations give
// bit-identical results, so the surface has no cracks.

struct Place {
  vec3 position;
  vec3 normal;
  vec2 uv;
};

// Samples all masks at `uv`. `lod`: 0, or higher to cover a neighbourhood.
void masksAt(vec2 uv, float lod, out vec4 masks[MASK_LAYERS]) {
  for (int layer = 0; layer < MASK_LAYERS; ++layer) {
#if WRINKLE_TEXTURE
    masks[layer] = textureLod(u_masks, vec3(uv, float(layer)), lod);
#else
    masks[layer] = vec4(0.0);
#endif
  }
}
