// SPDX-License-Identifier: Apache-2.0
// MakeHuman's expressions and lists of pose units: accepted weights are in [0, 1].
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "motion/makehuman/mhpose.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace furrow::motion;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto names = ParsePoseUnitNames(text, "fuzz.json");
  if (names.ok() && (names->empty() || names->size() > kMaxPoseUnits)) std::abort();
  const furrow::Result<MhPose> pose = ParseMhpose(text, "fuzz.mhpose");
  if (!pose.ok()) return 0;
  for (const auto& [unit, weight] : pose->units) {
    if (!(weight >= 0.0f && weight <= 1.0f)) std::abort();
  }
  return 0;
}
