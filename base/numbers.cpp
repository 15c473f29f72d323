// SPDX-License-Identifier: Apache-2.0
#include "base/numbers.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/text.h"

namespace furrow {
namespace {

constexpr double kBeyondFloat = 0x1.ffffffp127;  // halfway between the largest float and the next

// from_chars() reports underflow (1e-999) and overflow (1e999) alike. The position of the first
// non-zero digit relative to the point and the exponent tells them apart.
bool IsTiny(std::string_view digits) {
  const std::size_t e = std::min(digits.find_first_of("eE"), digits.size());
  const std::size_t point = std::min(digits.substr(0, e).find('.'), e);
  const std::size_t first = std::min(digits.find_first_of("123456789"), e);
  int exponent = 0;
  if (e < digits.size()) {
    std::string_view power = digits.substr(e + 1);
    if (power.starts_with('+')) power.remove_prefix(1);
    const auto result = std::from_chars(power.data(), power.data() + power.size(), exponent);
    if (result.ec != std::errc())
      return power.starts_with('-');  // the exponent outweighs any number of digits
  }
  return static_cast<long long>(point) + exponent < static_cast<long long>(first);
}

bool LooksNonFinite(std::string_view token) {
  return token.find('#') != std::string_view::npos;  // MSVC: 1.#INF, -1.#IND, 1.#QNAN
}

enum class Outcome { kNumber, kNonFinite, kNoNumber };

Outcome Convert(std::string_view token, double* value) {
  std::string_view digits = token;
  // from_chars() refuses a plus sign. "+-1" stays malformed.
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  const char* end = digits.data() + digits.size();
  const auto [rest, error] = std::from_chars(digits.data(), end, *value);
  if (error == std::errc::result_out_of_range && rest == end) {
    if (!IsTiny(digits)) return Outcome::kNonFinite;
    *value = 0.0;
    return Outcome::kNumber;
  }
  if (error != std::errc() || rest != end) {
    return LooksNonFinite(token) ? Outcome::kNonFinite : Outcome::kNoNumber;
  }
  // A value that does not round to a finite float would become infinite later. NaN compares false.
  const bool fits = std::abs(*value) < kBeyondFloat;
  return fits ? Outcome::kNumber : Outcome::kNonFinite;
}

template <class T>
std::optional<T> ToNumber(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

}  // namespace

Result<double> ParseNumber(std::string_view token, std::string_view where) {
  double value = 0.0;
  switch (Convert(token, &value)) {
    case Outcome::kNumber: return value;
    case Outcome::kNonFinite:
      return Status(StatusCode::kNonFinite, Quoted(token) + " is not a finite number",
                    std::string(where));
    case Outcome::kNoNumber: break;
  }
  const bool comma = token.find(',') != std::string_view::npos;
  return Status(StatusCode::kParse, Quoted(token) + " is not a number", std::string(where),
                comma ? "use a decimal point" : "");
}

bool TryParseNumber(std::string_view token, double* value) {
  return Convert(token, value) == Outcome::kNumber;
}

std::optional<float> ToFloat(std::string_view word) { return ToNumber<float>(word); }

std::optional<long> ToInteger(std::string_view word) { return ToNumber<long>(word); }

void AppendFixed(double value, int decimals, std::string* text) {
  char buffer[384];  // the largest double has 309 digits before the point
  const auto [end, error] =
      std::to_chars(buffer, buffer + sizeof(buffer), value, std::chars_format::fixed, decimals);
  if (error != std::errc()) return;
  std::string_view digits(buffer, static_cast<std::size_t>(end - buffer));
  if (digits.find('.') != std::string_view::npos) {
    while (digits.back() == '0') digits.remove_suffix(1);
    if (digits.back() == '.') digits.remove_suffix(1);
  }
  text->append(digits == "-0" ? std::string_view("0") : digits);
}

void AppendShortest(float value, std::string* text) {
  char buffer[64];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof(buffer), value);
  if (error == std::errc()) text->append(buffer, end);
}

}  // namespace furrow
