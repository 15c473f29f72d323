// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "base/status.h"
#include "wrinkle/rig/rig.h"

namespace furrow::wrinkle {

// What a rig may hold at most; far above any real one.
inline constexpr std::size_t kMaxReferencePoses = 1024;
inline constexpr std::size_t kMaxRigDrivers = 1024;
inline constexpr std::size_t kMaxRegions = 256;
inline constexpr std::size_t kMaxWrinkleMaps = 16;
inline constexpr std::size_t kMaxSources = 256;  // of one feed
// Regions times their maps: a map may stand once in a region.
inline constexpr std::size_t kMaxWeights = kMaxRegions * kMaxWrinkleMaps;
// Of one strain driver: all of its patch is computed on the stack.
inline constexpr std::size_t kMaxPatchVertices = 256;
inline constexpr std::size_t kMaxPatchTriangles = 512;
inline constexpr std::size_t kMaxPatchJoints = 32;
inline constexpr float kMaxBetaDegrees = 179.0f;  // of a hinge or ball: beyond, straight is flexed

inline constexpr float kMaxDerivativeScale = 100.0f;  // steeper than any surface that is drawn

// What can be said of a rig's poses, drivers, regions, maps and filter field by field: names well
// formed and unique, lists within limits and not empty where one entry is needed, every number
// finite and in its range (stated in rig.h). RigBinding::Create() asks it of every rig.
//
// - Names of drivers, values, regions and maps make up the names of wrinkle weights, which stand in
//   CSV headers, patterns and OSC addresses: no blanks, dots, quotes, slashes or brackets.
// - References between poses, drivers, maps and regions are checked where they are resolved.
//
// Errors: kInvalidArgument, kNonFinite and kLimit; `where` is the field as a path,
// "drivers[3].hinge.beta_degrees".
[[nodiscard]] Status CheckRigFields(const Rig& rig);

// A name of any printable text, at most 255 bytes. Errors as above, at `where`.
[[nodiscard]] Status CheckLabel(std::string_view label, const std::string& where);

// As CheckLabel(), and fit to be part of a wrinkle weight's name.
[[nodiscard]] Status CheckName(std::string_view name, const std::string& where);

}  // namespace furrow::wrinkle
