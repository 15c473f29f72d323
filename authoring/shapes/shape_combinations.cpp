// SPDX-License-Identifier: Apache-2.0
#include "authoring/shapes/shape_combinations.h"

namespace furrow::authoring {

std::span<const ShapeCombination> ShapeCombinations() {
  static const std::vector<ShapeCombination> kAll = {
      {"browInnerUp", {{"browInnerUp", 1}, {"browOuterUp*", 1}}},
      {"browDown*", {{"browDown*", 1}}},
      {"browDown*", {{"browDown*", 1}, {"noseSneer*", 1}}},
      {"noseSneer*", {{"noseSneer*", 1}, {"mouthUpperUp*", 1}}},
      {"cheekSquint*", {{"cheekSquint*", 1}, {"eyeBlink*", 1}}},
      {"eyeSquint*", {{"eyeSquint*", 1}, {"eyeBlink*", 0.5f}}},
      {"eyeWide*", {{"eyeWide*", 1}, {"browOuterUp*", 1}}},
      {"mouthSmile*", {{"mouthSmile*", 1}, {"cheekSquint*", 1}}},
      {"mouthSmile*", {{"mouthSmile*", 1}, {"jawOpen", 1}}},
      {"mouthPress*", {{"mouthPress*", 1}, {"mouthRollLower", 1}, {"mouthRollUpper", 1}}},
      {"mouthFrown*", {{"mouthFrown*", 1}, {"mouthShrugLower", 1}}},
      {"mouthStretch*", {{"mouthStretch*", 1}, {"jawOpen", 0.5f}}},
      {"mouthFunnel", {{"mouthFunnel", 1}, {"jawOpen", 0.5f}}},
  };
  return kAll;
}

std::vector<std::string> ShapesOf(const std::string& pattern) {
  if (!pattern.ends_with('*')) return {pattern};
  const std::string stem = pattern.substr(0, pattern.size() - 1);
  return {stem + "Left", stem + "Right"};
}

}  // namespace furrow::authoring
