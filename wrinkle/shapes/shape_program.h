// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/status.h"
#include "wrinkle/shapes/shape_formula.h"
#include "wrinkle/shapes/shape_rules.h"
#include "wrinkle/skeleton/pose.h"

namespace furrow::wrinkle {

// Computes the weights of a character's shapes (its morph targets) from the coefficients of a
// stream's blend shapes. Created once per stream, then run once per pose.
class ShapeProgram {
 public:
  // Limit of the intermediate results, which Run() keeps on its stack.
  static constexpr std::size_t kMaxSteps = 256;

  ShapeProgram() = default;  // no shapes

  // Each shape takes the coefficient of the stream's first blend shape of the same name, matched
  // without case. Other shapes stay at 0.
  [[nodiscard]] static ShapeProgram ByName(std::span<const std::string> blend_shapes,
                                           std::span<const std::string> shapes);

  // `steps`: intermediate results in the order of evaluation; a step reads coefficients and earlier
  // steps. `shapes`: pairs (shape, formula) in the order of evaluation, a shape at most once; they
  // read coefficients, steps and earlier shapes. Correctives come last. Other shapes stay at 0.
  // Errors: kLimit (too many steps); kInvalidArgument (a formula reads what comes later or does not
  // exist; a gain or tent that is not finite or not in order; an invalid fade).
  [[nodiscard]] static Result<ShapeProgram> Create(
      std::size_t num_shapes, std::span<const ShapeFormula> steps,
      std::span<const std::pair<std::size_t, ShapeFormula>> shapes);

  [[nodiscard]] std::size_t num_shapes() const { return num_shapes_; }
  // True if the stream moves none of the shapes.
  [[nodiscard]] bool empty() const { return shapes_.empty() && correctives_.empty(); }

  // Applies to every pose's weights. `rules` is for num_shapes() shapes.
  void SetRules(ShapeRules rules) { rules_ = std::move(rules); }

  // Writes num_shapes() weights. `coefficients` are in the stream's order; missing ones count as 0.
  // Does not allocate, and changes nothing on failure. Errors: kSizeMismatch (`weights` is too
  // short), kNonFinite.
  [[nodiscard]] JobStatus Run(std::span<const float> coefficients, std::span<float> weights) const;

 private:
  // All lists of a program are flat, because nested ones would scatter over memory.
  struct Term {
    float gain = 0.0f;
    std::uint32_t first = 0;  // in inputs_
    std::uint32_t last = 0;
  };
  // A formula whose terms are terms_[first] to terms_[last - 1].
  struct Sum {
    std::uint32_t first = 0;
    std::uint32_t last = 0;
    std::uint32_t shape = 0;  // unused by steps
    bool clamped = false;
    bool limited = false;
    ShapeInput at_most;
  };
  struct Fade {
    std::uint32_t shape = 0;
    Term by;  // gain: of each input
  };
  struct Values;

  [[nodiscard]] Sum Append(const ShapeFormula& formula, std::size_t shape);
  void AppendFade(const ShapeFade& fade, std::size_t shape);
  [[nodiscard]] float Evaluate(const Sum& sum, const Values& values) const;
  [[nodiscard]] float Evaluate(const Fade& fade, const Values& values) const;

  std::vector<Sum> steps_;
  std::vector<Sum> shapes_;
  std::vector<Fade> fades_;
  std::vector<Sum> correctives_;
  std::vector<Term> terms_;
  std::vector<ShapeInput> inputs_;
  std::size_t num_shapes_ = 0;
  ShapeRules rules_;
};

}  // namespace furrow::wrinkle
