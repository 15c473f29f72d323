// SPDX-License-Identifier: Apache-2.0
// BVH: an accepted file is a valid clip, and the written clip can be read again.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "motion/bvh/bvh.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace furrow::motion;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  ClipReport report;
  const furrow::Result<Clip> clip = ParseBvh(text, "fuzz.bvh", {}, &report);
  if (!clip.ok()) return 0;
  for (const furrow::wrinkle::Transform& local : clip->locals) {
    if (!furrow::wrinkle::IsValid(local)) std::abort();
  }
  const furrow::Result<std::string> written = BvhToText(*clip, &report);
  if (written.ok() && ParseBvh(*written, "written.bvh")->num_frames() != clip->num_frames()) {
    std::abort();
  }
  return 0;
}
