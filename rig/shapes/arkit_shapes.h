// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

// ARKit's 52 blend shapes. Shape maps translate every other vocabulary from and to them.
namespace furrow::rig {

inline constexpr int kNumArkitShapes = 52;

// The gaze, in degrees, that a coefficient of eyeLookUp and its like at 1 stands for. Our
// judgement, as ARKit states none.
inline constexpr float kFullGaze = 30.0f;

// The names in ARKit's own spelling, in the order of Live Link Face. Left and right are the
// performer's own.
[[nodiscard]] const std::array<std::string_view, kNumArkitShapes>& ArkitShapes();

// The index of a name, matched without case; -1 if it is not one of the 52.
[[nodiscard]] int FindArkitShape(std::string_view name);

// The same shape on the other side; the shape itself if it belongs to both sides.
[[nodiscard]] int MirroredArkitShape(int shape);

}  // namespace furrow::rig
