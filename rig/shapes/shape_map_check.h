// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "rig/shapes/shape_map.h"

namespace furrow::rig {

// What a shape map does, and what is probably not meant.
struct ShapeMapReport {
  std::string name;
  std::size_t num_shapes = 0;
  std::size_t num_from_arkit = 0;        // shapes that ARKit's can make
  std::vector<std::string> not_covered;  // ARKit's shapes that the vocabulary cannot make
  std::vector<std::string> one_way;      // ... that it makes, but that none of its shapes show
  std::vector<std::string> warnings;     // one sentence each
};

// Checks a map that ParseShapeMap() has accepted:
// - Raised alone, a shape of ARKit must not fall on the way to the vocabulary and back.
// - The formula of a shape on one side must be the mirror image of that on the other side.
[[nodiscard]] ShapeMapReport CheckShapeMap(const ShapeMap& map);

// Formats a report for a terminal.
[[nodiscard]] std::string ToText(const ShapeMapReport& report);

// A first map for names that no shipped map knows: shapes that one of `known` understands get that
// map's formula, the others get an empty one. JSON with comments. `name`: of the new map.
[[nodiscard]] std::string ProposeShapeMap(const std::string& name,
                                          std::span<const std::string> shapes,
                                          std::span<const ShapeMap> known);

}  // namespace furrow::rig
