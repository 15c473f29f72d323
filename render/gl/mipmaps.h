// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <epoxy/gl.h>

// Mip levels by a box filter of 2x2 texels, on the processor. For glGenerateTextureMipmap(), Mesa's
// llvmpipe compiles a program per texture format, which takes longer than this filter.
namespace furrow::render::gl {

// Where levels go: a texture with storage for all levels of the size, or a layer of an array.
struct MipTarget {
  GLuint texture = 0;
  int layer = -1;  // of an array; -1: the texture has no layers
  int width = 0;   // of level 0, texels
  int height = 0;
};

// The average of four texels where sRGB and linear values differ.
enum class MipSpace { kLinear, kSrgb };

// Uploads level 0, `texels`, and all further levels. `texels`: RGBA of 8 bits, width * height * 4,
// rows from the top. With kSrgb, the first three channels are averaged as linear values.
void UploadWithMips(const MipTarget& target, std::vector<std::uint8_t> texels, MipSpace space);
// The same for `channels` (1 or 4) floats per texel.
void UploadWithMips(const MipTarget& target, std::vector<float> texels, int channels);

// One level from the former one, of `width` x `height` texels. A side is halved and rounded down,
// to at least 1; the last row or column of an odd side counts to no texel, unless it is the only
// one.
[[nodiscard]] std::vector<std::uint8_t> HalfSize(const std::vector<std::uint8_t>& texels, int width,
                                                 int height, MipSpace space);
[[nodiscard]] std::vector<float> HalfSize(const std::vector<float>& texels, int width, int height,
                                          int channels);

}  // namespace furrow::render::gl
