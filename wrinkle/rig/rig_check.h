// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "base/status.h"
#include "wrinkle/fields/field_check.h"
#include "wrinkle/rig/rig.h"

namespace furrow::wrinkle {

// Limits of a rig, far above any real rig. Each driver kind states its own limits in its fields.
inline constexpr std::size_t kMaxReferencePoses = 1024;
inline constexpr std::size_t kMaxPoseShapes = 2048;  // of one reference pose
inline constexpr std::size_t kMaxRigDrivers = 1024;
inline constexpr std::size_t kMaxRegions = 256;
inline constexpr std::size_t kMaxWrinkleMaps = 16;
inline constexpr std::size_t kMaxSources = 256;     // of one feed
inline constexpr std::size_t kMaxCurvePoints = 16;  // of one modulation curve, which has at least 2
// The least step in x from point to point of a modulation curve. It limits the slope.
inline constexpr float kLeastCurveStep = 0.01f;
inline constexpr float kLeastAngleStep = 2.0f;  // the same for Feed::angles, degrees
// Regions times maps: a region uses a map at most once.
inline constexpr std::size_t kMaxWeights = kMaxRegions * kMaxWrinkleMaps;

inline constexpr float kMaxDerivativeScale = 100.0f;  // steeper than any surface that is drawn

// Checks a rig's poses, drivers, regions, maps and filter field by field: names are well-formed and
// unique, lists are within their limits and not empty if an entry is needed, and numbers are finite
// and in range (ranges: rig.h and the kinds' fields). RigBinding::Create() calls it for every rig.
//
// - Names of drivers, values, regions and maps make up the names of wrinkle weights, which appear
//   in CSV headers, patterns and OSC addresses: CheckName().
// - References between poses, drivers, maps and regions are checked when they are resolved.
//
// Errors: kInvalidArgument, kNonFinite and kLimit. `where` is the path of the field:
// "drivers[3].hinge.beta_degrees".
[[nodiscard]] Status CheckRigFields(const Rig& rig);

}  // namespace furrow::wrinkle
