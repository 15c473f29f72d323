// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <flatbuffers/flatbuffers.h>

#include "protocol/codec/decode_status.h"
#include "protocol/messages/messages.h"
#include "protocol/schema/common_generated.h"

// Fields that several messages share: text, names, numbers, masks. Only the units of this folder
// include this header, because it exposes FlatBuffers types.
//
// Each unit here offers two functions per message:
//   ReadTable(table, message)   checks every field of a verified table and copies it
//   WriteTable(payload, message)  adds the message to the payload and returns its table
namespace furrow::protocol::internal {

using TextOffset = flatbuffers::Offset<flatbuffers::String>;
using TextVector = flatbuffers::Vector<TextOffset>;

// The payload under construction, and scratch memory that is reused between messages.
struct PayloadBuilder {
  flatbuffers::FlatBufferBuilder builder{4096};
  std::vector<std::uint8_t> mask;
};

enum class Presence : std::uint8_t { kMayBeEmpty, kRequired };

// Copies text after checking it. An absent string reads as an empty one.
[[nodiscard]] DecodeStatus ReadText(const flatbuffers::String* text, int max_bytes,
                                    std::string& out, Presence presence = Presence::kMayBeEmpty);

// Returns 0 (absent) for empty text.
[[nodiscard]] TextOffset WriteText(PayloadBuilder& payload, std::string_view text);

// Names must be unique, non-empty, plain text and within the limits. An absent vector reads as an
// empty one.
[[nodiscard]] DecodeStatus CheckNames(const TextVector* names, int max_names);
[[nodiscard]] DecodeStatus ReadNames(const TextVector* names, int max_names,
                                     std::vector<std::string>& out);
// Returns 0 (absent) for an empty list.
[[nodiscard]] flatbuffers::Offset<TextVector> WriteNames(PayloadBuilder& payload,
                                                         const std::vector<std::string>& names);

// Finite, and at most kMaxMagnitude.
[[nodiscard]] DecodeStatus CheckNumber(float value);
[[nodiscard]] DecodeStatus CheckVector(const Vec3& value);
// Finite, and of unit length within 1e-3.
[[nodiscard]] DecodeStatus CheckRotation(const Quat& value);
// Frames per second in [0, kMaxRateHz].
[[nodiscard]] DecodeStatus CheckRate(float rate_hz);

// Expands a mask of `n` bits to ascending indices. An absent mask means all `n`, or none if
// `num_values` is 0. kBadCount unless there are `num_values` indices.
[[nodiscard]] DecodeStatus ReadMask(const flatbuffers::Vector<std::uint8_t>* mask, std::size_t n,
                                    std::size_t num_values, std::vector<std::uint16_t>& indices);

// Returns 0 (absent) if `indices` is empty or holds all `n`.
[[nodiscard]] flatbuffers::Offset<flatbuffers::Vector<std::uint8_t>> WriteMask(
    PayloadBuilder& payload, std::span<const std::uint16_t> indices, std::size_t n);

inline Vec3 FromWire(const wire::Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline Quat FromWire(const wire::Quat& q) { return {q.x(), q.y(), q.z(), q.w()}; }
inline wire::Vec3 ToWire(const Vec3& v) { return {v.x, v.y, v.z}; }
inline wire::Quat ToWire(const Quat& q) { return {q.x, q.y, q.z, q.w}; }

// 0 for an absent vector.
template <class T>
[[nodiscard]] std::size_t SizeOf(const flatbuffers::Vector<T>* vector) {
  return vector == nullptr ? 0 : vector->size();
}

}  // namespace furrow::protocol::internal
