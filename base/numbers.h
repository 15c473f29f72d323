// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/status.h"

// Numbers in text files. The decimal sign is a point, whatever the process's locale.
namespace furrow {

// Converts a whole token to a number: "1", "-.0083333", "+2.5e-3". Underflow gives 0. `where`, for
// example "file:line", is the place in errors.
//
// Errors: kNonFinite ("nan", "inf", MSVC's "1.#IND", or outside float's range), kParse (not a
// number).
[[nodiscard]] Result<double> ParseNumber(std::string_view token, std::string_view where);

// Does what ParseNumber() does, but returns false instead of building a message, for hot loops.
// `value` is then unchanged.
[[nodiscard]] bool TryParseNumber(std::string_view token, double* value);

// Converts a whole word to a number; nullopt if it is not one. Unlike ParseNumber(), these accept
// infinities and NaN, so that the caller can report kNonFinite itself.
[[nodiscard]] std::optional<float> ToFloat(std::string_view word);
[[nodiscard]] std::optional<long> ToInteger(std::string_view word);

// Appends `value` with at most `decimals` digits after the point, without trailing zeros; "-0"
// becomes "0".
void AppendFixed(double value, int decimals, std::string* text);
// Appends the shortest text that parses back to the same float.
void AppendShortest(float value, std::string* text);

}  // namespace furrow
