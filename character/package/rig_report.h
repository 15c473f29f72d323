// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/status.h"
#include "wrinkle/drivers/common/bind_options.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::character {

// The result of `furrow rig check` for a rig that has been read: its contents and its likely
// mistakes. LoadRig() reports errors in the file itself.
struct RigReport {
  std::string name;
  std::vector<std::pair<std::string, std::size_t>> counts;  // "drivers" -> 11
  std::vector<std::string> weight_names;                    // "<region>.<map>"
  std::vector<std::string> driver_value_names;              // "<driver>.<value>"
  std::vector<std::string> warnings;                        // one sentence each
  // Whether the rig binds strictly to the skeleton, as in `furrow solve`; Ok without a skeleton.
  Status binding;
  // Sum of the skeleton's bone lengths at rest (wrinkle::SkeletonSize()), which rigs state as
  // source_size; 0 without a skeleton.
  float skeleton_size = 0.0f;
};

struct RigReportOptions {
  // The skeleton to bind to, and the names of its blend shapes. nullptr: do not bind.
  const wrinkle::Skeleton* skeleton = nullptr;
  std::span<const std::string> blend_shape_names;
  // See BindOptions.
  std::span<const std::pair<std::string, std::string>> aliases;
  std::span<const wrinkle::RoleChain> role_chains;
  glm::quat turn = wrinkle::BindOptions().turn;
  // The folder that is searched for the rig's pictures, before FURROW_ASSET_PATH. Pictures embedded
  // in a character are listed in `embedded_pictures`.
  std::filesystem::path folder;
  std::span<const std::string> embedded_pictures;
};

// Lists the contents of a rig and its likely mistakes. Reads no file; only looks whether the rig's
// pictures exist.
[[nodiscard]] RigReport ReportOnRig(const wrinkle::Rig& rig, const RigReportOptions& options = {});

// Formats a report for a terminal: counts, names, warnings and the result of binding, one per line.
[[nodiscard]] std::string ToText(const RigReport& report);

}  // namespace furrow::character
