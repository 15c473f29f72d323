// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

// Tools spell the same shape in many ways: "head_geo.browDown_L", "BrowDownLeft", "brow down left".
namespace furrow::rig {

// The part of a name that names the shape: what follows the last ':', '|' or '.'. Digits after the
// last '.' are the counter of a copy ("jawOpen.001") and are removed.
[[nodiscard]] std::string_view ShapeNameCore(std::string_view name);

// Removes the first of the prefixes that fits, without case. A prefix is a literal in which '#'
// stands for a digit, or '*' and a literal, which matches everything up to the literal's last
// occurrence. A name that consists of a prefix alone stays.
[[nodiscard]] std::string_view WithoutShapePrefix(std::string_view core,
                                                  std::span<const std::string> prefixes);

// The form in which names are compared: the core without a prefix, split at '_', '-', blanks and
// changes of case, in lowercase, joined. "l" and "r" as words mean "left" and "right". If the name
// has a single such word, it moves to the end: "Eye_L_Blink" and "eyeBlinkLeft" are
// "eyeblinkleft". Names with two sides keep their order. Numbers lose leading zeros.
[[nodiscard]] std::string NormalShapeName(std::string_view name,
                                          std::span<const std::string> prefixes = {});

}  // namespace furrow::rig
