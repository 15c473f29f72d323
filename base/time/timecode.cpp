// SPDX-License-Identifier: Apache-2.0
#include "base/time/timecode.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>

#include "base/numbers.h"

namespace furrow {
namespace {

constexpr std::uint32_t kMinutesPerDay = 24 * 60;

// Frame numbers that drop-frame timecode leaves out in a minute that is not a multiple of ten.
std::uint32_t DroppedPerMinute(std::uint32_t nominal) { return nominal / 15; }

// The frame number that the text shows: `frame`, and the numbers that were left out before it.
std::uint32_t FrameNumber(const Timecode& timecode, std::uint32_t nominal) {
  if (!timecode.drop_frame) return timecode.frame;
  const std::uint32_t dropped = DroppedPerMinute(nominal);
  const std::uint32_t per_minute = 60 * nominal - dropped;
  const std::uint32_t per_ten_minutes = 10 * per_minute + dropped;
  const std::uint32_t tens = timecode.frame / per_ten_minutes;
  const std::uint32_t rest = timecode.frame % per_ten_minutes;
  // The first minute of ten has all its numbers, so it is longer than the others.
  const std::uint32_t minutes = rest < 60 * nominal ? 0 : (rest - dropped) / per_minute;
  return timecode.frame + dropped * (9 * tens + minutes);
}

bool IsDigits(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

// -1: the text is not a whole number, or too large.
int ReadDigits(std::string_view text) {
  int number = -1;
  // from_chars() leaves `number` as it is if the digits do not fit.
  if (IsDigits(text)) std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

}  // namespace

int NominalTimecodeRate(std::uint32_t numerator, std::uint32_t denominator) {
  if (numerator == 0 || denominator == 0) return 0;
  const std::uint64_t nominal = (std::uint64_t{numerator} + denominator - 1) / denominator;
  if (nominal > kMaxTimecodeRate) return 0;
  const std::uint64_t frames = nominal * denominator;
  return (frames - numerator) * 500 <= frames ? static_cast<int>(nominal) : 0;
}

bool HasDropFrame(std::uint32_t numerator, std::uint32_t denominator) {
  const int nominal = NominalTimecodeRate(numerator, denominator);
  return (nominal == 30 || nominal == 60) && numerator % denominator != 0;
}

std::uint32_t TimecodeFramesPerDay(const Timecode& timecode) {
  const auto [frame, numerator, denominator, subframe, drop_frame] = timecode;
  if (drop_frame && !HasDropFrame(numerator, denominator)) return 0;
  const auto nominal = static_cast<std::uint32_t>(NominalTimecodeRate(numerator, denominator));
  const std::uint32_t numbers = kMinutesPerDay * 60 * nominal;
  constexpr std::uint32_t kDroppingMinutes = kMinutesPerDay / 10 * 9;
  return drop_frame ? numbers - kDroppingMinutes * DroppedPerMinute(nominal) : numbers;
}

bool IsValid(const Timecode& timecode) { return timecode.frame < TimecodeFramesPerDay(timecode); }

std::optional<Timecode> MakeTimecode(std::int64_t frame, double subframe,
                                     std::int64_t rate_numerator, std::int64_t rate_denominator) {
  if (frame < 0 || rate_numerator <= 0 || rate_denominator <= 0 || !std::isfinite(subframe)) {
    return std::nullopt;
  }
  // Reduced, so that equal rates have equal numbers, and fit.
  const std::int64_t divisor = std::gcd(rate_numerator, rate_denominator);
  rate_numerator /= divisor;
  rate_denominator /= divisor;
  if (rate_numerator > std::numeric_limits<std::uint32_t>::max() ||
      rate_denominator > std::numeric_limits<std::uint16_t>::max()) {
    return std::nullopt;
  }
  Timecode timecode;
  timecode.rate_numerator = static_cast<std::uint32_t>(rate_numerator);
  timecode.rate_denominator = static_cast<std::uint16_t>(rate_denominator);
  timecode.drop_frame = HasDropFrame(timecode.rate_numerator, timecode.rate_denominator);
  timecode.subframe = static_cast<std::uint8_t>(std::clamp(subframe * 256.0, 0.0, 255.0));
  const std::int64_t day = TimecodeFramesPerDay(timecode);
  if (frame >= 2 * day) return std::nullopt;
  timecode.frame = static_cast<std::uint32_t>(frame % day);
  return timecode;
}

std::string TimecodeText(const Timecode& timecode) {
  const auto nominal = static_cast<std::uint32_t>(
      NominalTimecodeRate(timecode.rate_numerator, timecode.rate_denominator));
  const std::uint32_t number = FrameNumber(timecode, nominal);
  const std::uint32_t seconds = number / nominal;
  char text[32];
  std::snprintf(text, sizeof text, "%02u:%02u:%02u%c%0*u", seconds / 3600, seconds / 60 % 60,
                seconds % 60, timecode.drop_frame ? ';' : ':', nominal > 100 ? 3 : 2,
                number % nominal);
  return text;
}

std::optional<TimecodeFields> ParseTimecodeFields(std::string_view text) {
  const std::size_t last = text.find_last_of(":;");
  if (last == std::string_view::npos) return std::nullopt;
  TimecodeFields fields;
  fields.drop_frame = text[last] == ';';
  std::string_view clock = text.substr(0, last);  // HH:MM:SS
  for (int i = 0; i < 3; ++i) {
    const std::size_t end = clock.find(':');
    const int field = ReadDigits(clock.substr(0, end));
    if (field < 0 || field >= (i == 0 ? 24 : 60) || (end == std::string_view::npos) != (i == 2)) {
      return std::nullopt;
    }
    fields.seconds = fields.seconds * 60 + field;
    if (i < 2) clock.remove_prefix(end + 1);
  }
  const std::string_view frames = text.substr(last + 1);
  const std::size_t point = frames.find('.');
  const bool has_part = point != std::string_view::npos;
  if (!IsDigits(frames.substr(0, point)) || (has_part && !IsDigits(frames.substr(point + 1))) ||
      !TryParseNumber(frames, &fields.frames) || fields.frames >= kMaxTimecodeRate) {
    return std::nullopt;
  }
  return fields;
}

std::optional<Timecode> MakeTimecode(const TimecodeFields& fields, std::uint32_t rate_numerator,
                                     std::uint16_t rate_denominator) {
  const auto nominal =
      static_cast<std::uint32_t>(NominalTimecodeRate(rate_numerator, rate_denominator));
  if (fields.seconds < 0 || !(fields.frames >= 0.0) || fields.frames >= nominal) {
    return std::nullopt;
  }
  Timecode timecode{.rate_numerator = rate_numerator, .rate_denominator = rate_denominator};
  timecode.drop_frame = fields.drop_frame;
  if (fields.drop_frame && !HasDropFrame(rate_numerator, rate_denominator)) {
    timecode.rate_numerator = nominal * 1000;
    timecode.rate_denominator = 1001;
  }
  const auto seconds = static_cast<std::uint32_t>(fields.seconds);
  const auto frames = static_cast<std::uint32_t>(fields.frames);
  timecode.subframe = static_cast<std::uint8_t>((fields.frames - frames) * 256.0);
  timecode.frame = seconds * nominal + frames;
  if (timecode.drop_frame) {
    const std::uint32_t minutes = seconds / 60;
    const std::uint32_t dropped = DroppedPerMinute(nominal);
    if (minutes % 10 != 0 && seconds % 60 == 0 && frames < dropped) return std::nullopt;
    timecode.frame -= dropped * (minutes - minutes / 10);
  }
  return IsValid(timecode) ? std::optional(timecode) : std::nullopt;
}

std::optional<Timecode> ParseTimecode(std::string_view text, std::uint32_t rate_numerator,
                                      std::uint16_t rate_denominator) {
  const std::optional<TimecodeFields> fields = ParseTimecodeFields(text);
  return fields ? MakeTimecode(*fields, rate_numerator, rate_denominator) : std::nullopt;
}

}  // namespace furrow
