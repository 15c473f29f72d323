// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <nlohmann/json.hpp>

#include "base/time/timecode.h"
#include "server/http/request/json_reply.h"

namespace furrow::server {

// "10:00:00;00". Null: the source sends no timecode.
[[nodiscard]] inline Json TimecodeJson(const std::optional<Timecode>& timecode) {
  return timecode ? Json(TimecodeText(*timecode)) : Json();
}

// Frames per second. Null: the source sends no timecode.
[[nodiscard]] inline Json TimecodeRateJson(const std::optional<Timecode>& timecode) {
  return timecode ? Json(static_cast<double>(timecode->rate_numerator) / timecode->rate_denominator)
                  : Json();
}

}  // namespace furrow::server
