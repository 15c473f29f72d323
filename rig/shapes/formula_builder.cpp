// SPDX-License-Identifier: Apache-2.0
#include "rig/shapes/formula_builder.h"

#include <algorithm>

namespace furrow::rig {
namespace {

using wrinkle::ShapeInput;

const std::optional<ShapeInput>& InputOf(const MapTerm::Factor& factor, const ShapeInputs& inputs) {
  return inputs[static_cast<std::size_t>(factor.shape)];
}

// A missing shape rests at 0, so a factor 1 - shape does not need it.
bool HasInputs(const MapTerm& term, const ShapeInputs& inputs) {
  return std::ranges::all_of(term.product, [&](const MapTerm::Factor& factor) {
    return factor.rest || InputOf(factor, inputs).has_value();
  });
}

std::size_t NumTermsPresent(const MapFormula& formula, const ShapeInputs& inputs) {
  return static_cast<std::size_t>(std::ranges::count_if(
      formula.sum, [&](const MapTerm& term) { return HasInputs(term, inputs); }));
}

wrinkle::ShapeTerm Built(const MapTerm& term, const ShapeInputs& inputs) {
  wrinkle::ShapeTerm built{.gain = term.gain, .product = {}};
  for (const MapTerm::Factor& factor : term.product) {
    std::optional<ShapeInput> input = InputOf(factor, inputs);
    if (!input) continue;
    input->use = factor.rest ? ShapeInput::Use::kRest : ShapeInput::Use::kClamped;
    built.product.push_back(*input);
  }
  return built;
}

wrinkle::ShapeFormula Built(const MapFormula& formula, const ShapeInputs& inputs) {
  // A new name passes the value unchanged, so a renamed stream gives the same bits.
  if (const int shape = formula.RenamedShape(); shape >= 0) {
    return wrinkle::SameAs(*inputs[static_cast<std::size_t>(shape)]);
  }
  wrinkle::ShapeFormula built{.sum = {}, .clamped = true, .at_most = {}};
  float all = 0.0f;
  float present = 0.0f;
  for (const MapTerm& term : formula.sum) {
    all += term.gain;
    if (!HasInputs(term, inputs)) continue;
    present += term.gain;
    built.sum.push_back(Built(term, inputs));
  }
  // Gains of a mean are shares of 1, so that both eyes together close a face's only lids once.
  const float whole = std::min(all, 1.0f);
  if (formula.mean && present != whole) {
    for (wrinkle::ShapeTerm& term : built.sum) term.gain *= whole / present;
  }
  return built;
}

}  // namespace

std::optional<BuiltFormula> BuildFormula(std::span<const MapFormula> formulas,
                                         const ShapeInputs& inputs, bool only_complete) {
  std::size_t best = 0;
  std::size_t best_terms = 0;
  bool complete = false;
  for (std::size_t i = 0; i < formulas.size() && !complete; ++i) {
    const std::size_t terms = NumTermsPresent(formulas[i], inputs);
    complete = terms == formulas[i].sum.size();
    if (!complete && terms <= best_terms) continue;
    best = i;
    best_terms = terms;
  }
  if (best_terms == 0 || (only_complete && !complete)) return std::nullopt;
  return BuiltFormula{.formula = Built(formulas[best], inputs),
                      .renames = formulas[best].RenamedShape() >= 0,
                      // A sum adds up what there is; a mean changes its shares.
                      .fallback = best > 0 || (!complete && formulas[best].mean)};
}

}  // namespace furrow::rig
