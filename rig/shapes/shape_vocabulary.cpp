// SPDX-License-Identifier: Apache-2.0
#include "rig/shapes/shape_vocabulary.h"

#include <tuple>
#include <utility>

#include "base/ascii.h"
#include "rig/shapes/shape_names.h"

namespace furrow::rig {
namespace {

// Names of peers are not limited elsewhere.
constexpr std::size_t kMaxKnownName = 255;

std::string LowerCore(std::string_view name) {
  return AsciiLower(std::string(ShapeNameCore(name)));
}

// Larger is better.
auto RankOf(const VocabularyFit& fit, const ShapeVocabulary& vocabulary) {
  return std::tuple(fit.explained, fit.exact, -static_cast<int>(vocabulary.map().shapes.size()));
}

}  // namespace

ShapeVocabulary::ShapeVocabulary(ShapeMap map) : map_(std::move(map)) {
  for (std::size_t i = 0; i < map_.shapes.size(); ++i) {
    const int index = static_cast<int>(i);
    const MapShape& shape = map_.shapes[i];
    // emplace() keeps the first: the reader has rejected names of two shapes.
    exact_.emplace(LowerCore(shape.name), index);
    normal_.emplace(NormalShapeName(shape.name, map_.prefixes), index);
    for (const std::string& alias : shape.aliases) {
      normal_.emplace(NormalShapeName(alias, map_.prefixes), index);
    }
  }
}

ShapeVocabulary::Found ShapeVocabulary::Find(std::string_view name) const {
  if (name.empty() || name.size() > kMaxKnownName) return {};
  if (const auto found = exact_.find(LowerCore(name)); found != exact_.end()) {
    return {found->second, true};
  }
  const auto found = normal_.find(NormalShapeName(name, map_.prefixes));
  return found == normal_.end() ? Found{} : Found{found->second, false};
}

VocabularyFit ShapeVocabulary::Fit(std::span<const std::string> names) const {
  VocabularyFit fit;
  std::vector<bool> seen(map_.shapes.size(), false);
  for (const std::string& name : names) {
    const Found found = Find(name);
    if (found.shape < 0) {
      ++fit.unexplained;
    } else if (!seen[static_cast<std::size_t>(found.shape)]) {
      seen[static_cast<std::size_t>(found.shape)] = true;
      ++fit.explained;
      fit.exact += found.exact ? 1 : 0;
    }
  }
  return fit;
}

const ShapeVocabulary* BestVocabulary(std::span<const ShapeVocabulary> vocabularies,
                                      std::span<const std::string> names, int at_least) {
  const ShapeVocabulary* best = nullptr;
  VocabularyFit best_fit;
  for (const ShapeVocabulary& vocabulary : vocabularies) {
    const VocabularyFit fit = vocabulary.Fit(names);
    if (fit.explained < at_least) continue;
    if (best != nullptr && RankOf(fit, vocabulary) <= RankOf(best_fit, *best)) continue;
    best = &vocabulary;
    best_fit = fit;
  }
  return best;
}

}  // namespace furrow::rig
