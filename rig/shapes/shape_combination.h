// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "rig/shapes/shape_vocabulary.h"
#include "wrinkle/shapes/shape_formula.h"

namespace furrow::rig {

// Finds the correctives of a face by their names. Combinations: "a_b", "a_x_b", "a__b", also with a
// common side at the end ("a_b_L"; "a_b_LR" takes both sides), for two shapes or more. In-betweens:
// "jawOpen50" is full at jawOpen 0.5 and gone at its neighbours or at 0 and 1. (Names as in Meta's
// OculusXRFaceCorrectiveNamingScheme, and as studios write them.)
class ShapeCombinations {
 public:
  using Product = std::vector<wrinkle::ShapeInput>;

  // `vocabulary` knows other spellings of the parts; null: equal names only. Both outlive this
  // object.
  ShapeCombinations(std::span<const std::string> targets, const ShapeVocabulary* vocabulary);

  // The inputs, each the weight of another target, whose product is the weight of this one.
  // nullopt: the name is not that of a corrective.
  [[nodiscard]] std::optional<Product> Find(std::string_view target) const;

 private:
  using Parts = std::vector<std::string>;

  [[nodiscard]] std::optional<std::size_t> TargetOf(std::string_view part) const;
  [[nodiscard]] std::optional<wrinkle::ShapeInput> InputOf(std::string_view part) const;
  [[nodiscard]] std::optional<Product> InputsOf(const std::string& part, const Parts& sides) const;
  [[nodiscard]] std::optional<Product> ProductOf(const Parts& parts, const Parts& sides) const;
  [[nodiscard]] std::optional<Product> SplitAnywhere(const Parts& words, const Parts& sides) const;
  [[nodiscard]] std::optional<Product> Split(const Parts& words, const Parts& sides) const;

  std::unordered_map<std::string, std::size_t> by_name_;           // lowercase cores
  std::unordered_map<int, std::size_t> by_shape_;                  // of the vocabulary
  std::unordered_map<std::size_t, std::vector<int>> in_betweens_;  // target -> percent, sorted
  const ShapeVocabulary* vocabulary_;
};

}  // namespace furrow::rig
