// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

// The limits on recordings from outside. A reader returns kLimit before it allocates more. Two
// hours of 100 joints at 30 Hz fit. gltf/limits.h limits glTF files, mcap::ReaderLimits MCAP files.
namespace furrow::motion {

inline constexpr std::uint64_t kMaxFileBytes = 512ull << 20;  // BVH and CSV
inline constexpr std::size_t kMaxFrames = 4'000'000;
inline constexpr std::size_t kMaxTransforms = 32'000'000;        // frames x joints
inline constexpr std::size_t kMaxBlendShapeValues = 64'000'000;  // frames x blend shapes
inline constexpr std::size_t kMaxBlendShapes = 2048;             // of a clip

}  // namespace furrow::motion
