// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "rig/shapes/shape_map.h"

namespace furrow::rig {

// How well the names of a stream or a face fit a vocabulary.
struct VocabularyFit {
  int explained = 0;    // distinct shapes of the map that are named
  int unexplained = 0;  // names that the map does not know
  int exact = 0;        // names in the map's own spelling, without case
};

// A shape map with an index of its names.
class ShapeVocabulary {
 public:
  struct Found {
    int shape = -1;      // index into map().shapes; -1: unknown
    bool exact = false;  // in the map's own spelling, without case
  };

  explicit ShapeVocabulary(ShapeMap map);

  [[nodiscard]] const ShapeMap& map() const { return map_; }
  // The shape that a name means: equal normal forms (NormalShapeName()), never a similar name.
  // Names longer than 255 bytes are unknown.
  [[nodiscard]] Found Find(std::string_view name) const;
  [[nodiscard]] VocabularyFit Fit(std::span<const std::string> names) const;

 private:
  ShapeMap map_;
  std::unordered_map<std::string, int> normal_;
  std::unordered_map<std::string, int> exact_;  // lowercase cores
};

// The vocabulary that explains the most names. A tie goes to the one in whose own spelling more
// names are, then to the smaller one, then to the first. Null if none explains `at_least` names.
[[nodiscard]] const ShapeVocabulary* BestVocabulary(std::span<const ShapeVocabulary> vocabularies,
                                                    std::span<const std::string> names,
                                                    int at_least);

}  // namespace furrow::rig
