// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "authoring/export/export_plan.h"
#include "base/status.h"
#include "character/character.h"
#include "render/wrinkles/derivative_map.h"

// The pictures of an export. All are pure functions of the character's pictures.
namespace furrow::authoring {

// How an engine stores normals.
struct NormalFormat {
  int bits = 8;             // per channel: 8 or 16
  bool green_down = false;  // green below the middle leans upwards in the picture (DirectX)
};

// Tangent-space unit normals n = normalize(slope.x, slope.y, 1), stored as n * 0.5 + 0.5 in three
// channels. Precondition: the map has width * height slopes.
[[nodiscard]] character::Picture NormalMapPicture(const render::DerivativeMap& slopes,
                                                  const NormalFormat& format);

// A derivative map: dh/dx in red and dh/dy in green, where h are the heights of the relief; blue is
// 0. x runs along u; y points up in the picture, or down with NormalFormat::green_down. A texel t
// in [0, 1] means (2 t - 1) * `scale`; the scale is the largest derivative, at least 0.001. These
// are the derivatives of surface gradients (Mikkelsen 2010, "Bump Mapping Unparametrized Surfaces
// on the GPU"; 2020, "Surface Gradient-Based Bump Mapping Framework"): -n.xy / n.z of the normal
// map.
struct DerivativePicture {
  character::Picture picture;
  float scale = 1.0f;
};
[[nodiscard]] DerivativePicture DerivativeMapPicture(const render::DerivativeMap& slopes,
                                                     const NormalFormat& format);

// The slopes of a wrinkle map at full weight, before its amplitude. Precondition: has_relief().
[[nodiscard]] render::DerivativeMap SlopesOf(const character::Character& character,
                                             const ExportPlan::Map& map);

// A height map of one channel and 16 bits; a texel t in [0, 1] means (2 t - 1) * `millimetres`.
struct HeightMap {
  character::Picture picture;
  float millimetres = 1.0f;
};
// `millimetres`: of an integer source, which is kept. A float source gets its largest height, at
// least 0.001.
[[nodiscard]] HeightMap HeightMapOf(const character::Picture& source, float millimetres);

// The masks of up to four regions in red, green, blue and alpha, 8 bits. Sources of other sizes are
// resampled bilinearly; unused channels are 0. Appends to `shared` the regions whose masks
// differ where the surface shares texels (PaintedMask::is_shared).
[[nodiscard]] character::Picture MaskPicture(const character::Character& character,
                                             const ExportPlan::Mask& mask,
                                             std::vector<std::string>* shared);

// The picture with 8 or 16 bits per channel; float pictures become RGBA of 8 bits.
[[nodiscard]] character::Picture IntegerPicture(const character::Picture& picture);

}  // namespace furrow::authoring
