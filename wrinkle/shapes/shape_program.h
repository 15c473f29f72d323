// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "wrinkle/skeleton/pose.h"

namespace furrow::wrinkle {

// Computes the weights of a character's shapes (its morph targets) from the coefficients of a
// stream's blend shapes. Created once per stream, then run once per pose.
class ShapeProgram {
 public:
  ShapeProgram() = default;  // no shapes

  // Each shape takes the coefficient of the stream's first blend shape of the same name, matched
  // without case. Other shapes stay at 0.
  [[nodiscard]] static ShapeProgram ByName(std::span<const std::string> blend_shapes,
                                           std::span<const std::string> shapes);

  [[nodiscard]] std::size_t num_shapes() const { return num_shapes_; }
  // True if the stream moves none of the shapes.
  [[nodiscard]] bool empty() const { return terms_.empty(); }

  // Writes num_shapes() weights. `coefficients` are in the stream's order; missing ones count as 0.
  // Does not allocate, and changes nothing on failure. Errors: kSizeMismatch (`weights` is too
  // short), kNonFinite.
  [[nodiscard]] JobStatus Run(std::span<const float> coefficients, std::span<float> weights) const;

 private:
  struct Term {
    std::size_t blend_shape;
    std::size_t shape;
    float gain;
  };
  std::vector<Term> terms_;
  std::size_t num_shapes_ = 0;
};

}  // namespace furrow::wrinkle
