// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

namespace furrow::authoring {

// ARKit's blend shapes that people make together, at the weights given. Folds of such a face are
// deeper than, or elsewhere than, those of the single shapes.
struct ShapeCombination {
  struct Part {
    const char* shape;  // "*" at the end stands for Left and Right, both
    float weight;
  };
  const char* lead;  // the shape that raises the wrinkle weight, written as in `parts`
  std::vector<Part> parts;
};

[[nodiscard]] std::span<const ShapeCombination> ShapeCombinations();

// The names that a pattern stands for: "browDown*" is browDownLeft and browDownRight.
[[nodiscard]] std::vector<std::string> ShapesOf(const std::string& pattern);

}  // namespace furrow::authoring
