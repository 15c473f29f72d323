// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

// What we accept from a file that somebody else made. Beyond these a reader answers kLimit before
// it allocates; each is far above real recordings (a two-hour take of 100 joints at 30 Hz fits).
namespace furrow::motion {

inline constexpr std::uint64_t kMaxFileBytes = 512ull << 20;
inline constexpr std::size_t kMaxFrames = 4'000'000;
inline constexpr std::size_t kMaxTransforms = 32'000'000;        // frames x joints
inline constexpr std::size_t kMaxBlendShapeValues = 64'000'000;  // frames x blend shapes
inline constexpr std::size_t kMaxBlendShapes = 2048;

}  // namespace furrow::motion
