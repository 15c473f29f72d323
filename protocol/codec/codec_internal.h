// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <flatbuffers/flatbuffers.h>

#include "protocol/codec/codec.h"

// What the codec_*.cpp files share. Included by them alone: here are the FlatBuffers types.
namespace furrow::protocol {

struct Encoder::State {
  flatbuffers::FlatBufferBuilder builder{4096};
  std::vector<std::uint8_t> mask;
};

namespace internal {

using Builder = flatbuffers::FlatBufferBuilder;
using TextOffset = flatbuffers::Offset<flatbuffers::String>;
using TextVector = flatbuffers::Vector<TextOffset>;

// The file identifier of a kind; nullptr for kUnknown.
[[nodiscard]] const char* Identifier(MessageKind kind);

// The payload at an address that is a multiple of 8, as FlatBuffers' loads want it: itself, or a
// copy in memory of this thread that lives until the next call.
[[nodiscard]] const std::uint8_t* AlignedPayload(std::span<const std::uint8_t> payload);

// Kind, then FlatBuffers' own checks within the limits of limits.h.
template <class Root>
[[nodiscard]] DecodeStatus Verify(const MessageView& view, MessageKind kind, const Root*& root) {
  if (view.kind != kind) return DecodeStatus::kWrongKind;
  const std::uint8_t* payload = AlignedPayload(view.payload);
  flatbuffers::Verifier verifier(payload, view.payload.size(), kMaxVerifierDepth,
                                 kMaxVerifierTables);
  if (!verifier.VerifyBuffer<Root>(Identifier(kind))) return DecodeStatus::kUnverified;
  root = flatbuffers::GetRoot<Root>(payload);
  return DecodeStatus::kOk;
}

// Ends the buffer and writes envelope and payload to `out`.
template <class Root>
void Finish(Builder& builder, flatbuffers::Offset<Root> root, const Header& header,
            MessageKind kind, std::vector<std::uint8_t>& out) {
  builder.Finish(root, Identifier(kind));
  WriteMessage(header, {builder.GetBufferPointer(), builder.GetSize()}, out);
}

enum class Presence : std::uint8_t { kMayBeEmpty, kRequired };

// Copies checked text; an absent string is an empty one.
[[nodiscard]] DecodeStatus ReadText(const flatbuffers::String* text, int max_bytes,
                                    std::string& out, Presence presence = Presence::kMayBeEmpty);

// 0 (absent) for empty text.
[[nodiscard]] TextOffset WriteText(Builder& builder, std::string_view text);

// Not empty, plain, unique, within the limits. An absent vector is an empty one.
[[nodiscard]] DecodeStatus CheckNames(const TextVector* names, int max_names);
[[nodiscard]] DecodeStatus ReadNames(const TextVector* names, int max_names,
                                     std::vector<std::string>& out);

// Finite and of at most kMaxMagnitude; a rotation of unit length within 1e-3.
[[nodiscard]] DecodeStatus CheckNumber(float value);
[[nodiscard]] DecodeStatus CheckVector(const Vec3& value);
[[nodiscard]] DecodeStatus CheckRotation(const Quat& value);
// Frames a second: [0, kMaxRateHz].
[[nodiscard]] DecodeStatus CheckRate(float rate_hz);

// Expands a mask of n bits (absent: all, unless there are no values) to ascending indices.
[[nodiscard]] DecodeStatus ReadMask(const flatbuffers::Vector<std::uint8_t>* mask, std::size_t n,
                                    std::size_t num_values, std::vector<std::uint16_t>& indices);

// 0 (absent) where the indices are all of n, or left out.
[[nodiscard]] flatbuffers::Offset<flatbuffers::Vector<std::uint8_t>> WriteMask(
    Encoder::State& state, std::span<const std::uint16_t> indices, std::size_t n);

template <class T>
[[nodiscard]] std::size_t SizeOf(const flatbuffers::Vector<T>* vector) {
  return vector == nullptr ? 0 : vector->size();
}

}  // namespace internal
}  // namespace furrow::protocol

// Returns from the enclosing function unless `expression` is kOk.
#define FURROW_CHECK_DECODE(expression)                                  \
  do {                                                                   \
    const ::furrow::protocol::DecodeStatus check_status_ = (expression); \
    if (check_status_ != ::furrow::protocol::DecodeStatus::kOk) {        \
      return check_status_;                                              \
    }                                                                    \
  } while (false)
