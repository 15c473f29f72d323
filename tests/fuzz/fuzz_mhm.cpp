// SPDX-License-Identifier: Apache-2.0
// MakeHuman's saves, targets and materials: values, indices and offsets are in range.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "authoring/import/makehuman/formats/mhm.h"
#include "authoring/import/makehuman/formats/mhmat.h"
#include "authoring/import/makehuman/formats/mhtarget.h"
#include "authoring/import/makehuman/save/macro_factors.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace furrow::authoring;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  constexpr std::size_t kVertices = 100;
  if (const auto target = ParseMhTarget(text, "fuzz.target", kVertices); target.ok()) {
    if (target->vertices.size() != target->offsets.size()) std::abort();
    for (const std::uint32_t vertex : target->vertices) {
      if (vertex >= kVertices) std::abort();
    }
  }
  if (const auto material = ParseMhmat(text, "fuzz.mhmat"); material.ok()) {
    for (int c = 0; c < 3; ++c) {
      if (!(material->colour[c] >= 0.0f && material->colour[c] <= 1.0f)) std::abort();
    }
  }
  const auto save = ParseMhm(text, "fuzz.mhm");
  if (!save.ok()) return 0;
  for (const MhmSave::Modifier& modifier : save->modifiers) {
    if (!(modifier.value >= -1.0f && modifier.value <= 1.0f)) std::abort();
  }
  for (const float share : FactorsOf(MacroValuesOf(*save)).share) {
    if (!(share >= -1e-5f && share <= 1.0f + 1e-5f)) std::abort();
  }
  return 0;
}
