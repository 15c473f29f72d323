// SPDX-License-Identifier: Apache-2.0
#include "protocol/codec/wire_fields.h"

#include <algorithm>
#include <cmath>

#include "protocol/messages/limits.h"
#include "protocol/messages/text.h"

namespace furrow::protocol::internal {
namespace {

// Bit 0 of a timecode's flags. Receivers ignore the others.
constexpr std::uint8_t kDropFrameFlag = 1;

}  // namespace

DecodeStatus ReadText(const flatbuffers::String* text, int max_bytes, std::string& out,
                      Presence presence) {
  out.clear();
  if (text == nullptr || text->size() == 0) {
    return presence == Presence::kRequired ? DecodeStatus::kMissingField : DecodeStatus::kOk;
  }
  if (text->size() > static_cast<std::size_t>(max_bytes)) return DecodeStatus::kLimit;
  if (!IsPlainText(text->string_view())) return DecodeStatus::kBadText;
  out.assign(text->c_str(), text->size());
  return DecodeStatus::kOk;
}

TextOffset WriteText(PayloadBuilder& payload, std::string_view text) {
  return text.empty() ? TextOffset(0) : payload.builder.CreateString(text.data(), text.size());
}

DecodeStatus CheckNames(const TextVector* names, int max_names) {
  if (names == nullptr) return DecodeStatus::kOk;
  if (names->size() > static_cast<std::size_t>(max_names)) return DecodeStatus::kLimit;
  // Sorting finds duplicates in n log n steps, whatever names a hostile sender chooses.
  std::vector<std::string_view> sorted;
  sorted.reserve(names->size());
  for (const flatbuffers::String* name : *names) {
    if (name->size() == 0) return DecodeStatus::kBadText;
    if (name->size() > kMaxNameBytes) return DecodeStatus::kLimit;
    if (!IsPlainText(name->string_view())) return DecodeStatus::kBadText;
    sorted.push_back(name->string_view());
  }
  std::sort(sorted.begin(), sorted.end());
  const bool duplicated = std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
  return duplicated ? DecodeStatus::kBadText : DecodeStatus::kOk;
}

DecodeStatus ReadNames(const TextVector* names, int max_names, std::vector<std::string>& out) {
  FURROW_CHECK_DECODE(CheckNames(names, max_names));
  out.resize(SizeOf(names));
  for (std::size_t i = 0; i < out.size(); ++i) {
    const flatbuffers::String* name = names->Get(static_cast<flatbuffers::uoffset_t>(i));
    out[i].assign(name->c_str(), name->size());
  }
  return DecodeStatus::kOk;
}

flatbuffers::Offset<TextVector> WriteNames(PayloadBuilder& payload,
                                           const std::vector<std::string>& names) {
  if (names.empty()) return 0;
  return payload.builder.CreateVectorOfStrings(names);
}

DecodeStatus CheckNumber(float value) {
  if (!std::isfinite(value)) return DecodeStatus::kNonFinite;
  return std::fabs(value) <= kMaxMagnitude ? DecodeStatus::kOk : DecodeStatus::kBadValue;
}

DecodeStatus CheckVector(const Vec3& value) {
  FURROW_CHECK_DECODE(CheckNumber(value.x));
  FURROW_CHECK_DECODE(CheckNumber(value.y));
  return CheckNumber(value.z);
}

DecodeStatus CheckRotation(const Quat& q) {
  // Finite components can have an infinite square, which the comparison with 1 rejects.
  const float squared = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  if (!std::isfinite(q.x) || !std::isfinite(q.y) || !std::isfinite(q.z) || !std::isfinite(q.w)) {
    return DecodeStatus::kNonFinite;
  }
  return std::fabs(std::sqrt(squared) - 1.0f) <= 1e-3f ? DecodeStatus::kOk : DecodeStatus::kNotUnit;
}

DecodeStatus CheckRate(float rate_hz) {
  FURROW_CHECK_DECODE(CheckNumber(rate_hz));
  return rate_hz >= 0.0f && rate_hz <= kMaxRateHz ? DecodeStatus::kOk : DecodeStatus::kBadValue;
}

DecodeStatus ReadMask(const flatbuffers::Vector<std::uint8_t>* mask, std::size_t n,
                      std::size_t num_values, std::vector<std::uint16_t>& indices) {
  indices.clear();
  if (mask == nullptr) {
    // An absent mask is the common case of whole poses; it saves bytes.
    if (num_values != 0 && num_values != n) return DecodeStatus::kBadCount;
    for (std::size_t i = 0; i < num_values; ++i) indices.push_back(static_cast<std::uint16_t>(i));
    return DecodeStatus::kOk;
  }
  // Bit i % 8 of byte i / 8 is entry i.
  if (mask->size() != (n + 7) / 8) return DecodeStatus::kBadCount;
  for (std::size_t i = 0; i < mask->size() * std::size_t{8}; ++i) {
    if ((mask->Get(static_cast<flatbuffers::uoffset_t>(i / 8)) >> (i % 8) & 1) == 0) continue;
    // Bits behind the last joint must be 0.
    if (i >= n || indices.size() == num_values) return DecodeStatus::kBadCount;
    indices.push_back(static_cast<std::uint16_t>(i));
  }
  return indices.size() == num_values ? DecodeStatus::kOk : DecodeStatus::kBadCount;
}

flatbuffers::Offset<flatbuffers::Vector<std::uint8_t>> WriteMask(
    PayloadBuilder& payload, std::span<const std::uint16_t> indices, std::size_t n) {
  if (indices.empty() || indices.size() == n) return 0;
  payload.mask.assign((n + 7) / 8, 0);
  for (const std::uint16_t index : indices) {
    payload.mask[index / 8] =
        static_cast<std::uint8_t>(payload.mask[index / 8] | 1u << (index % 8));
  }
  return payload.builder.CreateVector(payload.mask);
}

std::optional<Timecode> ReadTimecode(const wire::Timecode* timecode) {
  if (timecode == nullptr) return std::nullopt;
  const Timecode found{.frame = timecode->frame(),
                       .rate_numerator = timecode->rate_numerator(),
                       .rate_denominator = timecode->rate_denominator(),
                       .subframe = timecode->subframe(),
                       .drop_frame = (timecode->flags() & kDropFrameFlag) != 0};
  return IsValid(found) ? std::optional(found) : std::nullopt;
}

wire::Timecode ToWire(const Timecode& timecode) {
  return {timecode.frame, timecode.rate_numerator, timecode.rate_denominator, timecode.subframe,
          timecode.drop_frame ? kDropFrameFlag : std::uint8_t{0}};
}

}  // namespace furrow::protocol::internal
