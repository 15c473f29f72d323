// SPDX-License-Identifier: Apache-2.0
#include "common/frame.glsl"
#include "wrinkles/masks.glsl"
#include "common/math.glsl"

// A patch's corner on its way from control to evaluation. Edges and corners have owners, whose
// place, normal and UV all patches take that meet there (render/mesh/displacement_patches.h): what is
// computed of them in the same order is the same to the bit, so nothing gapes.

struct Place {
  vec3 position;
  vec3 normal;
  vec2 uv;
};

// Masks at a place. `lod`: 0, or above where a whole neighbourhood is asked for.
void masksAt(vec2 uv, float lod, out vec4 masks[MASK_LAYERS]) {
  for (int layer = 0; layer < MASK_LAYERS; ++layer) {
#if WRINKLE_TEXTURE
    masks[layer] = textureLod(u_masks, vec3(uv, float(layer)), lod);
#else
    masks[layer] = vec4(0.0);
#endif
  }
}
