// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/shapes/shape_program.h"

#include <algorithm>

#include "base/ascii.h"
#include "wrinkle/skeleton/finite.h"

namespace furrow::wrinkle {

ShapeProgram ShapeProgram::ByName(std::span<const std::string> blend_shapes,
                                  std::span<const std::string> shapes) {
  ShapeProgram program;
  program.num_shapes_ = shapes.size();
  for (std::size_t shape = 0; shape < shapes.size(); ++shape) {
    const auto found = std::find_if(
        blend_shapes.begin(), blend_shapes.end(),
        [&](const std::string& name) { return EqualsIgnoreCase(name, shapes[shape]); });
    if (found == blend_shapes.end()) continue;
    program.terms_.push_back({.blend_shape = static_cast<std::size_t>(found - blend_shapes.begin()),
                              .shape = shape,
                              .gain = 1.0f});
  }
  return program;
}

JobStatus ShapeProgram::Run(std::span<const float> coefficients, std::span<float> weights) const {
  if (weights.size() < num_shapes_) return JobStatus::kSizeMismatch;
  if (!AllFinite(coefficients)) return JobStatus::kNonFinite;
  std::fill_n(weights.begin(), num_shapes_, 0.0f);
  for (const Term& term : terms_) {
    if (term.blend_shape >= coefficients.size()) continue;
    weights[term.shape] += term.gain * coefficients[term.blend_shape];
  }
  return JobStatus::kOk;
}

}  // namespace furrow::wrinkle
