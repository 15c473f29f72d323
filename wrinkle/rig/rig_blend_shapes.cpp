// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/rig/rig_blend_shapes.h"

#include <algorithm>
#include <set>

#include "base/ascii.h"

namespace furrow::wrinkle {

std::vector<std::string> BlendShapesOf(const Rig& rig) {
  std::vector<std::string> names;
  std::set<std::string> seen;
  const auto add = [&](const auto& fields) {
    if constexpr (requires { BlendShapesRead(fields); }) {
      for (const std::string& name : BlendShapesRead(fields)) {
        if (seen.insert(AsciiLower(name)).second) names.push_back(name);
      }
    }
  };
  for (const Driver& driver : rig.drivers) VisitFields(driver, add);
  return names;
}

bool ReadsAny(const Rig& rig, std::span<const std::string> blend_shapes) {
  std::set<std::string> sent;
  for (const std::string& name : blend_shapes) sent.insert(AsciiLower(name));
  return std::ranges::any_of(
      BlendShapesOf(rig), [&](const std::string& name) { return sent.contains(AsciiLower(name)); });
}

}  // namespace furrow::wrinkle
