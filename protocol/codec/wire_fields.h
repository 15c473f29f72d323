// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
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

// Copies a plain text (text.h) of at most `max_bytes` to `out`. An absent string (null) reads as an
// empty one. kLimit, kBadText; kMissingField for an empty text that is kRequired.
[[nodiscard]] DecodeStatus ReadText(const flatbuffers::String* text, int max_bytes,
                                    std::string& out, Presence presence = Presence::kMayBeEmpty);

// Returns 0 (absent) for empty text.
[[nodiscard]] TextOffset WriteText(PayloadBuilder& payload, std::string_view text);

// Both check that names are unique, not empty, plain text, and within `max_names` and
// kMaxNameBytes. An absent vector (null) reads as an empty one.
[[nodiscard]] DecodeStatus CheckNames(const TextVector* names, int max_names);
[[nodiscard]] DecodeStatus ReadNames(const TextVector* names, int max_names,
                                     std::vector<std::string>& out);
// Returns 0 (absent) for an empty list.
[[nodiscard]] flatbuffers::Offset<TextVector> WriteNames(PayloadBuilder& payload,
                                                         const std::vector<std::string>& names);

// Checks that every component is finite and has a magnitude of at most kMaxMagnitude.
[[nodiscard]] DecodeStatus CheckNumber(float value);
[[nodiscard]] DecodeStatus CheckVector(const Vec3& value);
// Checks that the quaternion is finite and that its length is within 1e-3 of 1.
[[nodiscard]] DecodeStatus CheckRotation(const Quat& value);
// Checks that a rate in frames per second is in [0, kMaxRateHz].
[[nodiscard]] DecodeStatus CheckRate(float rate_hz);

// Expands a mask of `n` bits (bit i % 8 of byte i / 8 stands for index i) to the ascending indices
// of the set bits. An absent mask (null) means all `n` indices, or none if `num_values` is 0.
// kBadCount unless the result has `num_values` indices.
[[nodiscard]] DecodeStatus ReadMask(const flatbuffers::Vector<std::uint8_t>* mask, std::size_t n,
                                    std::size_t num_values, std::vector<std::uint16_t>& indices);

// Returns 0 (absent) if `indices` is empty or holds all `n`.
[[nodiscard]] flatbuffers::Offset<flatbuffers::Vector<std::uint8_t>> WriteMask(
    PayloadBuilder& payload, std::span<const std::uint16_t> indices, std::size_t n);

inline Vec3 FromWire(const wire::Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline Quat FromWire(const wire::Quat& q) { return {q.x(), q.y(), q.z(), q.w()}; }
inline wire::Vec3 ToWire(const Vec3& v) { return {v.x, v.y, v.z}; }
inline wire::Quat ToWire(const Quat& q) { return {q.x, q.y, q.z, q.w}; }

// An absent timecode (null), and one that is invalid, read as nullopt: a publisher's wrong clock
// must not cost its poses.
[[nodiscard]] std::optional<Timecode> ReadTimecode(const wire::Timecode* timecode);
[[nodiscard]] wire::Timecode ToWire(const Timecode& timecode);

// The number of elements; 0 for an absent vector (null).
template <class T>
[[nodiscard]] std::size_t SizeOf(const flatbuffers::Vector<T>* vector) {
  return vector == nullptr ? 0 : vector->size();
}

}  // namespace furrow::protocol::internal
