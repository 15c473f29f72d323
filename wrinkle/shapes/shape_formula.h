// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace furrow::wrinkle {

// One number that a shape's formula reads.
struct ShapeInput {
  enum class From : std::uint8_t {
    kBlendShape,  // a coefficient of the stream
    kStep,        // an earlier intermediate result of the program
    kShape,       // the weight of a shape that the program computes earlier
  };
  enum class Use : std::uint8_t {
    kValue,    // unchanged
    kClamped,  // clamp(v, 0, 1)
    kRest,     // 1 - clamp(v, 0, 1)
    kTent,     // 1 at `at`, 0 at `before` and `after` and beyond, linear in between
  };
  From from = From::kBlendShape;
  Use use = Use::kValue;
  std::uint32_t index = 0;
  // For kTent: before < at < after.
  float before = 0.0f;
  float at = 0.5f;
  float after = 1.0f;

  [[nodiscard]] bool operator==(const ShapeInput&) const = default;
};

// gain * product of the inputs. Without inputs: the gain.
struct ShapeTerm {
  float gain = 1.0f;
  std::vector<ShapeInput> product;
};

// How other values fade a formula: the factor 1 - share * mean of the inputs.
struct ShapeFade {
  float share = 1.0f;          // [0, 1]
  std::vector<ShapeInput> by;  // not empty; read as ShapeInput::Use says, normally kClamped
};

// The sum of the terms; if `clamped`, in [0, 1]; if `at_most` is set, no more than that input; if
// `fade` is set, times its factor. Fades read weights after the rules of the face, so a lid does
// not fade by a blink that a rule has stopped. Correctives read weights after the fades, as drawn.
struct ShapeFormula {
  std::vector<ShapeTerm> sum;
  bool clamped = false;
  std::optional<ShapeInput> at_most;
  std::optional<ShapeFade> fade = std::nullopt;
  bool is_corrective = false;
};

// The formula of a shape that equals `input`.
[[nodiscard]] inline ShapeFormula SameAs(const ShapeInput& input) {
  return {.sum = {{.gain = 1.0f, .product = {input}}}, .clamped = false, .at_most = {}};
}

}  // namespace furrow::wrinkle
