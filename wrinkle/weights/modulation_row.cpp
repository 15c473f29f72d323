// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/weights/modulation_row.h"

#include <algorithm>
#include <iterator>

namespace furrow::wrinkle {
namespace {

constexpr float kNeverReached = 2.0f;  // values end at 1

}  // namespace

void ModulationRow::Set(const FeedModulation& modulation, std::size_t lane) {
  const bool has_curve = !modulation.curve.empty();
  const Modulation named = has_curve ? Modulation::kLinear : modulation.modulation;
  is_cosine.at[lane] = named == Modulation::kCosine ? -1 : 0;
  is_cubic.at[lane] = named == Modulation::kCubic ? -1 : 0;
  is_curve.at[lane] = has_curve ? -1 : 0;
  all_cosine = all_cosine && named == Modulation::kCosine;
  any_cubic = any_cubic || named == Modulation::kCubic;

  const std::vector<CurvePiece> pieces = CurvePieces(modulation.curve);
  while (curve.size() < pieces.size()) {
    std::ranges::fill(curve.emplace_back().from.at, kNeverReached);
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    curve[i].from.at[lane] = pieces[i].from;
    for (std::size_t k = 0; k < std::size(pieces[i].c); ++k)
      curve[i].c[k].at[lane] = pieces[i].c[k];
  }
}

}  // namespace furrow::wrinkle
