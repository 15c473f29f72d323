// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/status.h"

// Numbers in text files: a point is the decimal sign whatever the process's locale says.
namespace furrow {

// A whole token as a number: "1", "-.0083333", "+2.5e-3".
// `where` ("file:line") goes into the error.
//
// Errors: kNonFinite ("nan", "inf", MSVC's "1.#IND", or beyond a float's range), kParse (anything
// else that is not a number). Too small to be told from 0 is 0.
[[nodiscard]] Result<double> ParseNumber(std::string_view token, std::string_view where);

// As ParseNumber() without an error's text, for hot loops: false where ParseNumber() would fail.
[[nodiscard]] bool TryParseNumber(std::string_view token, double* value);

// A whole word as a number; nullopt for anything else. Unlike ParseNumber(), accepts infinities and
// NaN, so that the caller can report kNonFinite itself.
[[nodiscard]] std::optional<float> ToFloat(std::string_view word);
[[nodiscard]] std::optional<long> ToInteger(std::string_view word);

// Appends `value` with at most `decimals` digits after the
// point, trailing zeros dropped; "-0" is "0".
void AppendFixed(double value, int decimals, std::string* text);
// Appends the shortest text that reads back as the same float.
void AppendShortest(float value, std::string* text);

}  // namespace furrow
