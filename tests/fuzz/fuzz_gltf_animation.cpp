// SPDX-License-Identifier: Apache-2.0
// glTF, GLB and VRMA: every accepted file gives a clip of valid transforms and finite values.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "motion/gltf/gltf_animation.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace furrow::motion;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  ClipReport report;
  const furrow::Result<Clip> clip = ParseGltfAnimation(bytes, "fuzz.glb", {}, &report);
  if (!clip.ok()) return 0;
  for (const furrow::wrinkle::Transform& local : clip->locals) {
    if (!furrow::wrinkle::IsValid(local)) std::abort();
  }
  for (const float value : clip->blend_shapes) {
    if (!std::isfinite(value)) std::abort();
  }
  return 0;
}
