// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <string>

#include "base/status.h"
#include "rig/skeleton_match.h"

namespace furrow::rig {

// A matcher with the skeleton maps of the source tree, whatever is installed on this machine.
// `map`: that of SkeletonMatcher::Create().
inline Result<SkeletonMatcher> ShippedMatcher(const std::string& map = {}) {
  setenv("FURROW_DATA_DIR", FURROW_SOURCE_DIR "/rig", 1);
  Result<SkeletonMatcher> matcher = SkeletonMatcher::Create(map);
  unsetenv("FURROW_DATA_DIR");
  return matcher;
}

}  // namespace furrow::rig
