// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/status.h"
#include "motion/clip/clip.h"

// MakeHuman's expressions. A .mhpose file states weights of pose units. The pose units are the
// frames of face-poseunits.bvh, and face-poseunits.json names these frames.
namespace furrow::motion {

// Real files have at most 60 units and 2 KiB.
inline constexpr std::uint64_t kMaxMhposeBytes = 1u << 20;
inline constexpr std::size_t kMaxPoseUnits = 4096;

// The content of a .mhpose file.
struct MhPose {
  std::string name;  // the field "name"; empty if it is missing or not printable
  std::vector<std::pair<std::string, float>> units;  // (pose unit, weight in [0, 1]), file order
};

// Parses a .mhpose file: a JSON object with "unit_poses", an object of weights. Weights outside
// [0, 1] are clamped with a warning. Other fields are ignored.
//
// Errors name `source` and the line or field: kParse, kSchema, kNonFinite, kLimit.
[[nodiscard]] Result<MhPose> ParseMhpose(std::string_view text, std::string_view source,
                                         ClipReport* report = nullptr);

// Parses face-poseunits.json: "framemapping" lists the name of each frame. Errors: those of
// ParseMhpose().
[[nodiscard]] Result<std::vector<std::string>> ParsePoseUnitNames(std::string_view text,
                                                                  std::string_view source);

// Blends pose units to a clip of one frame at time 0. A joint's departure from its rest rotation is
// scaled by slerp, and the departures of all units are multiplied in the order of the file, as
// MakeHuman does. Translations are those of the rest pose.
//
// `names`: the names of the frames of `units`. `source`: the .mhpose file. Errors: kNotFound (an
// unknown pose unit), kSchema (more names than frames, no joints).
[[nodiscard]] Result<Clip> BlendPoseUnits(const MhPose& pose, const std::vector<std::string>& names,
                                          const Clip& units, std::string_view source);

}  // namespace furrow::motion
