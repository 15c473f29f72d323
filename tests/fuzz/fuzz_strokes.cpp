// SPDX-License-Identifier: Apache-2.0
// Strokes: an accepted file names only maps and regions of the rig, and all numbers are in range.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "authoring/bake/strokes_file.h"

namespace {

using furrow::authoring::BakeStroke;

furrow::wrinkle::Rig SmallRig() {
  furrow::wrinkle::Rig rig;
  rig.wrinkle_maps = {{.name = "stretch"}, {.name = "squash"}};
  for (const char* name : {"brow_l", "brow_r", "glabella"}) rig.regions.emplace_back().name = name;
  return rig;
}

bool Within(float value, float least, float most) { return value >= least && value <= most; }

bool IsSound(const BakeStroke& stroke, const furrow::wrinkle::Rig& rig) {
  const auto is_map = [&](const std::string& name) {
    return std::ranges::any_of(rig.wrinkle_maps, [&](const auto& map) { return map.name == name; });
  };
  const auto is_region = [&](const std::string& name) {
    return std::ranges::any_of(rig.regions,
                               [&](const auto& region) { return region.name == name; });
  };
  const auto is_finite = [](const glm::vec3& point) {
    return std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z);
  };
  return !stroke.maps.empty() && std::ranges::all_of(stroke.maps, is_map) &&
         (stroke.region.empty() || is_region(stroke.region)) && stroke.points.size() >= 2 &&
         std::ranges::all_of(stroke.points, is_finite) && stroke.width_mm > 0.0f &&
         stroke.width_mm <= 200.0f && Within(stroke.depth_mm, -50.0f, 50.0f) &&
         Within(stroke.ridge, 0.0f, 1.0f) && stroke.taper > 0.0f && stroke.taper <= 1.0f &&
         Within(stroke.wavelength_mm, 0.0f, 200.0f);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const furrow::wrinkle::Rig rig = SmallRig();
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto strokes = furrow::authoring::ParseStrokes(text, "fuzz.json", rig);
  if (!strokes.ok()) {
    if (!strokes.status().where().starts_with("fuzz.json")) std::abort();
    return 0;
  }
  for (const BakeStroke& stroke : *strokes) {
    if (!IsSound(stroke, rig)) std::abort();
  }
  return 0;
}
