// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "authoring/import/makehuman/formats/mhm.h"
#include "authoring/import/makehuman/save/macro_factors.h"

namespace furrow::authoring {

// A target of the data folder. Its path tells what it is for: the parts of folder and file
// names between hyphens are either macro words, which scale it, or parts of its group.
// "macrodetails/height/female-old-maxmuscle-maxweight-maxheight.target" is in the group
// "macrodetails-height".
struct TargetFile {
  std::filesystem::path path;  // below the folder `targets`
  std::vector<int> words;      // indices into kMacroWords, at most one per variable
};

// The targets of a data folder by group.
class TargetLibrary {
 public:
  // Adds a target. `path`: below the folder `targets`. The caller adds paths in their order.
  void Add(const std::filesystem::path& path);

  // The files of a group, as added; empty if there is no such group.
  [[nodiscard]] const std::vector<TargetFile>& InGroup(const std::string& group) const;
  // True if a file of the group has the macro word.
  [[nodiscard]] bool HasWord(const std::string& group, std::string_view word) const;

 private:
  std::map<std::string, std::vector<TargetFile>> groups_;
};

// A target and how much of it a person has.
struct ChosenTarget {
  std::filesystem::path path;  // below the folder `targets`
  float weight = 0.0f;         // in (0, 1]
};

// What ChooseTargets() found.
struct TargetChoice {
  std::vector<ChosenTarget> targets;
  int modifiers = 0;  // modifiers that are not macros and have targets
  std::vector<std::string> warnings;
};

// Chooses the targets that make the person of `save`. The weight of a target is the product of the
// shares of its macro words and, for modifiers that are not macros, the modifier's value.
//
// - A two-sided modifier "group/name-low|high" selects "group-name-low" for negative values and
//   "group-name-high" for positive ones.
// - Where the folder has no target of a race or age that the person has, the share goes to
//   those that it has, with a warning: races in proportion, ages to the nearest.
// - Modifiers without a target in the folder are skipped, with a warning that names them.
[[nodiscard]] TargetChoice ChooseTargets(const MhmSave& save, const TargetLibrary& library);

}  // namespace furrow::authoring
