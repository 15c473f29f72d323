// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace furrow::render {

// Conversions of whole arrays between floats and half floats (IEEE 754 binary16, as bits), with the
// instructions of the processor. `from` and `to` have the same length. Values that no half float
// represents are rounded to the nearest; ties go to the even one.
void ToHalfFloats(std::span<const float> from, std::span<std::uint16_t> to);
void FromHalfFloats(std::span<const std::uint16_t> from, std::span<float> to);

}  // namespace furrow::render
