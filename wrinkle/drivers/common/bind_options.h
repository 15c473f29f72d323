// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <utility>

namespace furrow::wrinkle {

// How RigBinding::Create() treats names that the skeleton lacks.
struct BindOptions {
  // false: a joint or blend shape that the skeleton lacks is an error. true (live streams): its
  // driver rests at 0 and RigBinding lists it as missing.
  bool allow_missing = false;
  // Pairs (joint name in the rig, joint name in the skeleton), tried if the skeleton has no joint
  // with the rig's name.
  std::span<const std::pair<std::string, std::string>> aliases;
};

}  // namespace furrow::wrinkle
