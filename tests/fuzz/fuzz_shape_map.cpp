// SPDX-License-Identifier: Apache-2.0
// Shape maps: an accepted map knows its own names, and its programs stay in [0, 1].
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "rig/shapes/shape_map_check.h"
#include "rig/shapes/shape_match.h"

namespace {

void RunAll(const furrow::wrinkle::ShapeProgram& program, std::size_t num_inputs) {
  std::vector<float> weights(program.num_shapes());
  for (const float value : {0.0f, 0.5f, 1.0f}) {
    const std::vector<float> coefficients(num_inputs, value);
    if (program.Run(coefficients, weights) != furrow::wrinkle::JobStatus::kOk) std::abort();
    for (const float weight : weights) {
      if (!(weight >= 0.0f && weight <= 1.0f)) std::abort();
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace furrow;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto map = rig::ParseShapeMap(text, "fuzz.json");
  if (!map.ok()) {
    if (!map.status().where().starts_with("fuzz.json")) std::abort();
    return 0;
  }
  std::vector<std::string> names;
  for (const rig::MapShape& shape : map->shapes) names.push_back(shape.name);
  const std::vector<std::string> arkit(rig::ArkitShapes().begin(), rig::ArkitShapes().end());
  const rig::ShapeMatcher matcher({}, &*map);
  RunAll(matcher.Match(names, arkit).program, names.size());
  RunAll(matcher.Match(arkit, names).program, arkit.size());
  const std::vector<wrinkle::ShapeRule> rules = {
      {.shape = 0, .gaze = wrinkle::ShapeRule::Gaze{.input = 0.0f, .output = 1.0f}, .contains = 1},
      {.shape = 1, .limits = {wrinkle::ShapeRule::Limits::kBlend}, .contains = 0}};
  RunAll(matcher.MatchFace(names, arkit, rules).program, names.size());
  RunAll(matcher.MatchFace(arkit, names, rules).program, arkit.size());
  (void)rig::CheckShapeMap(*map);
  return 0;
}
