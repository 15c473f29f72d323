// SPDX-License-Identifier: Apache-2.0
#include "base/utc_time.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>

namespace furrow {
namespace {

constexpr std::uint64_t kEndOfYear9999 = 253'402'300'799;
constexpr std::string_view kForm = "0000-00-00T00:00:00Z";  // 0: a digit

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

int Digits(std::string_view text, std::size_t at, std::size_t count) {
  int value = 0;
  for (std::size_t i = at; i < at + count; ++i) value = value * 10 + (text[i] - '0');
  return value;
}

}  // namespace

std::string FormatUtc(std::uint64_t unix_seconds) {
  namespace ch = std::chrono;
  const ch::sys_seconds time{ch::seconds{std::min(unix_seconds, kEndOfYear9999)}};
  const auto day = ch::floor<ch::days>(time);
  const ch::year_month_day date{day};
  const ch::hh_mm_ss clock{time - day};
  char text[32];
  std::snprintf(text, sizeof text, "%04d-%02u-%02uT%02d:%02d:%02dZ", int{date.year()},
                unsigned{date.month()}, unsigned{date.day()},
                static_cast<int>(clock.hours().count()), static_cast<int>(clock.minutes().count()),
                static_cast<int>(clock.seconds().count()));
  return text;
}

std::optional<std::uint64_t> ParseUtc(std::string_view text) {
  namespace ch = std::chrono;
  if (text.size() != kForm.size()) return std::nullopt;
  for (std::size_t i = 0; i < kForm.size(); ++i) {
    if (kForm[i] == '0' ? !IsDigit(text[i]) : text[i] != kForm[i]) return std::nullopt;
  }
  const ch::year_month_day date{ch::year{Digits(text, 0, 4)},
                                ch::month{static_cast<unsigned>(Digits(text, 5, 2))},
                                ch::day{static_cast<unsigned>(Digits(text, 8, 2))}};
  const int hours = Digits(text, 11, 2);
  const int minutes = Digits(text, 14, 2);
  const int seconds = Digits(text, 17, 2);
  if (!date.ok() || date.year() < ch::year{1970} || hours > 23 || minutes > 59 || seconds > 59) {
    return std::nullopt;
  }
  const auto days = ch::sys_days{date}.time_since_epoch().count();
  return static_cast<std::uint64_t>(days) * 86'400 +
         static_cast<std::uint64_t>(hours * 3'600 + minutes * 60 + seconds);
}

std::optional<std::uint64_t> ParseDuration(std::string_view text) {
  constexpr std::uint64_t kMost = 36'525ULL * 86'400;
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end + 1 != text.data() + text.size()) return std::nullopt;
  std::uint64_t unit = 0;
  switch (*end) {
    case 's': unit = 1; break;
    case 'm': unit = 60; break;
    case 'h': unit = 3'600; break;
    case 'd': unit = 86'400; break;
    default: return std::nullopt;
  }
  if (number == 0 || number > kMost / unit) return std::nullopt;
  return number * unit;
}

}  // namespace furrow
