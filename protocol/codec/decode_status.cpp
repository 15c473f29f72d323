// SPDX-License-Identifier: Apache-2.0
#include "protocol/codec/decode_status.h"

#include <array>
#include <cstddef>

namespace furrow::protocol {
namespace {

constexpr std::array<std::string_view, kNumDecodeStatuses> kStatusNames = {
    "ok",         "too_short",    "bad_magic",  "bad_version", "bad_flags",     "bad_session",
    "bad_length", "unknown_kind", "wrong_kind", "unverified",  "missing_field", "bad_count",
    "limit",      "non_finite",   "not_unit",   "bad_value",   "bad_text",      "bad_hash"};

}  // namespace

std::string_view DecodeStatusName(DecodeStatus status) {
  const auto index = static_cast<std::size_t>(status);
  return index < kStatusNames.size() ? kStatusNames[index] : "unknown";
}

}  // namespace furrow::protocol
