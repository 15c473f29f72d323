// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/shapes/shape_program.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/ascii.h"
#include "base/status.h"
#include "wrinkle/skeleton/finite.h"

namespace furrow::wrinkle {
namespace {

using From = ShapeInput::From;
using Use = ShapeInput::Use;

float Clamped(float value) { return std::clamp(value, 0.0f, 1.0f); }

float Tent(const ShapeInput& input, float value) {
  const float side = value <= input.at ? (value - input.before) / (input.at - input.before)
                                       : (input.after - value) / (input.after - input.at);
  return std::max(side, 0.0f);
}

float Shaped(const ShapeInput& input, float value) {
  switch (input.use) {
    case Use::kValue: return value;
    case Use::kClamped: return Clamped(value);
    case Use::kRest: return 1.0f - Clamped(value);
    case Use::kTent: return Tent(input, value);
  }
  return value;
}

// Checks formulas in the order of their evaluation.
class FormulaCheck {
 public:
  explicit FormulaCheck(std::size_t num_shapes) : known_shapes_(num_shapes, false) {}

  [[nodiscard]] Status Check(const ShapeFormula& formula) const {
    for (const ShapeTerm& term : formula.sum) {
      if (!std::isfinite(term.gain)) return Error("a gain is not finite");
      for (const ShapeInput& input : term.product) FURROW_RETURN_IF_ERROR(Check(input));
    }
    if (formula.at_most) FURROW_RETURN_IF_ERROR(Check(*formula.at_most));
    return formula.fade ? Check(*formula.fade) : Status();
  }
  void AddStep() { ++known_steps_; }
  [[nodiscard]] Status AddShape(std::size_t shape) {
    if (shape >= known_shapes_.size()) return Error("there is no such shape");
    if (known_shapes_[shape]) return Error("a shape has two formulas");
    known_shapes_[shape] = true;
    return {};
  }

 private:
  static Status Error(const char* what) {
    return {StatusCode::kInvalidArgument, what, "shape program"};
  }
  [[nodiscard]] Status Check(const ShapeFade& fade) const {
    // The negation also rejects NaN.
    if (!(fade.share >= 0.0f && fade.share <= 1.0f) || fade.by.empty()) {
      return Error("a fade has no inputs, or a share that is not between 0 and 1");
    }
    for (const ShapeInput& input : fade.by) FURROW_RETURN_IF_ERROR(Check(input));
    return {};
  }
  [[nodiscard]] Status Check(const ShapeInput& input) const {
    const bool known = input.from == From::kBlendShape ||
                       (input.from == From::kStep
                            ? input.index < known_steps_
                            : input.index < known_shapes_.size() && known_shapes_[input.index]);
    if (!known) return Error("a formula reads a value that is not computed before");
    // The negation also rejects NaN.
    if (input.use == Use::kTent && !(input.before < input.at && input.at < input.after)) {
      return Error("a tent's positions are not in order");
    }
    return {};
  }

  std::size_t known_steps_ = 0;
  std::vector<bool> known_shapes_;
};

}  // namespace

struct ShapeProgram::Values {
  std::span<const float> coefficients;
  std::span<const float> steps;
  std::span<const float> shapes;

  [[nodiscard]] float Of(const ShapeInput& input) const {
    switch (input.from) {
      case From::kBlendShape:
        // Senders may leave out coefficients at the end.
        return input.index < coefficients.size() ? coefficients[input.index] : 0.0f;
      case From::kStep: return steps[input.index];
      case From::kShape: return shapes[input.index];
    }
    return 0.0f;
  }
};

ShapeProgram ShapeProgram::ByName(std::span<const std::string> blend_shapes,
                                  std::span<const std::string> shapes) {
  ShapeProgram program;
  program.num_shapes_ = shapes.size();
  for (std::size_t shape = 0; shape < shapes.size(); ++shape) {
    const auto found = std::find_if(
        blend_shapes.begin(), blend_shapes.end(),
        [&](const std::string& name) { return EqualsIgnoreCase(name, shapes[shape]); });
    if (found == blend_shapes.end()) continue;
    const auto index = static_cast<std::uint32_t>(found - blend_shapes.begin());
    program.shapes_.push_back(program.Append(SameAs({.index = index}), shape));
  }
  return program;
}

Result<ShapeProgram> ShapeProgram::Create(
    std::size_t num_shapes, std::span<const ShapeFormula> steps,
    std::span<const std::pair<std::size_t, ShapeFormula>> shapes) {
  if (steps.size() > kMaxSteps) {
    return Status(StatusCode::kLimit, "has more than 256 steps", "shape program");
  }
  ShapeProgram program;
  program.num_shapes_ = num_shapes;
  FormulaCheck check(num_shapes);
  for (const ShapeFormula& step : steps) {
    FURROW_RETURN_IF_ERROR(check.Check(step));
    check.AddStep();
    program.steps_.push_back(program.Append(step, 0));
  }
  for (const auto& [shape, formula] : shapes) {
    FURROW_RETURN_IF_ERROR(check.Check(formula));
    FURROW_RETURN_IF_ERROR(check.AddShape(shape));
    if (!formula.is_corrective && !program.correctives_.empty()) {
      return Status(StatusCode::kInvalidArgument, "a corrective is not last", "shape program");
    }
    auto& sums = formula.is_corrective ? program.correctives_ : program.shapes_;
    sums.push_back(program.Append(formula, shape));
    if (formula.fade) program.AppendFade(*formula.fade, shape);
  }
  return program;
}

ShapeProgram::Sum ShapeProgram::Append(const ShapeFormula& formula, std::size_t shape) {
  Sum sum{.first = static_cast<std::uint32_t>(terms_.size()),
          .last = 0,
          .shape = static_cast<std::uint32_t>(shape),
          .clamped = formula.clamped,
          .limited = formula.at_most.has_value(),
          .at_most = formula.at_most.value_or(ShapeInput())};
  for (const ShapeTerm& term : formula.sum) {
    const auto first = static_cast<std::uint32_t>(inputs_.size());
    inputs_.insert(inputs_.end(), term.product.begin(), term.product.end());
    terms_.push_back({term.gain, first, static_cast<std::uint32_t>(inputs_.size())});
  }
  sum.last = static_cast<std::uint32_t>(terms_.size());
  return sum;
}

void ShapeProgram::AppendFade(const ShapeFade& fade, std::size_t shape) {
  const auto first = static_cast<std::uint32_t>(inputs_.size());
  inputs_.insert(inputs_.end(), fade.by.begin(), fade.by.end());
  fades_.push_back({static_cast<std::uint32_t>(shape),
                    {fade.share / static_cast<float>(fade.by.size()), first,
                     static_cast<std::uint32_t>(inputs_.size())}});
}

float ShapeProgram::Evaluate(const Sum& sum, const Values& values) const {
  float total = 0.0f;
  for (std::uint32_t t = sum.first; t < sum.last; ++t) {
    float product = terms_[t].gain;
    for (std::uint32_t i = terms_[t].first; i < terms_[t].last; ++i) {
      product *= Shaped(inputs_[i], values.Of(inputs_[i]));
    }
    total += product;
  }
  if (sum.clamped) total = Clamped(total);
  if (sum.limited) total = std::min(total, Shaped(sum.at_most, values.Of(sum.at_most)));
  return total;
}

float ShapeProgram::Evaluate(const Fade& fade, const Values& values) const {
  float sum = 0.0f;
  for (std::uint32_t i = fade.by.first; i < fade.by.last; ++i) {
    sum += Shaped(inputs_[i], values.Of(inputs_[i]));
  }
  return 1.0f - fade.by.gain * sum;
}

JobStatus ShapeProgram::Run(std::span<const float> coefficients, std::span<float> weights) const {
  if (weights.size() < num_shapes_) return JobStatus::kSizeMismatch;
  if (!AllFinite(coefficients)) return JobStatus::kNonFinite;
  std::fill_n(weights.begin(), num_shapes_, 0.0f);
  std::array<float, kMaxSteps> steps{};
  const Values values{coefficients, steps, weights};
  for (std::size_t i = 0; i < steps_.size(); ++i) steps[i] = Evaluate(steps_[i], values);
  for (const Sum& shape : shapes_) weights[shape.shape] = Evaluate(shape, values);
  if (!rules_.empty()) rules_.Apply(weights.first(num_shapes_));
  for (const Fade& fade : fades_) weights[fade.shape] *= Evaluate(fade, values);
  for (const Sum& shape : correctives_) weights[shape.shape] = Evaluate(shape, values);
  return JobStatus::kOk;
}

}  // namespace furrow::wrinkle
