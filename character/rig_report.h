// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/status.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::character {

// What `furrow rig check` says about a rig that has been read: what is in it, and what is probably
// not meant. Errors of the file itself are LoadRig()'s.
struct RigReport {
  std::string name;
  std::vector<std::pair<std::string, std::size_t>> counts;  // "drivers" -> 11
  std::vector<std::string> weight_names;                    // "<region>.<map>"
  std::vector<std::string> driver_value_names;              // "<driver>.<value>"
  std::vector<std::string> warnings;  // one sentence each; empty: nothing to say
  // With a skeleton: whether the rig binds strictly, as `furrow solve` does; Ok without one.
  Status binding;
  float skeleton_size = 0.0f;  // what source_size and offset_size mean; 0: none given
};

struct RigReportOptions {
  // The skeleton to try it on, if any, and the blend shapes that come with it.
  const wrinkle::Skeleton* skeleton = nullptr;
  std::span<const std::string> blend_shape_names;
  // See BindOptions::aliases.
  std::span<const std::pair<std::string, std::string>> aliases;
  // Where the rig's pictures are looked up (then FURROW_ASSET_PATH); a picture inside a character
  // is known by `embedded_pictures`.
  std::filesystem::path folder;
  std::span<const std::string> embedded_pictures;
};

[[nodiscard]] RigReport ReportOnRig(const wrinkle::Rig& rig, const RigReportOptions& options = {});

// For a terminal: counts, names, warnings, and the binding's verdict, one a line.
[[nodiscard]] std::string ToText(const RigReport& report);

}  // namespace furrow::character
