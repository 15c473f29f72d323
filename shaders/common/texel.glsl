// SPDX-License-Identifier: Apache-2.0

// A texel of `picture`, clamped to its border.
vec4 texelInside(sampler2D picture, ivec2 pixel) {
  return texelFetch(picture, clamp(pixel, ivec2(0), textureSize(picture, 0) - 1), 0);
}
