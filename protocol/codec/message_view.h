// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "protocol/codec/decode_status.h"
#include "protocol/framing/envelope.h"
#include "protocol/messages/limits.h"
#include "protocol/messages/messages.h"

namespace furrow::protocol {

// The kind of a message, from the FlatBuffers file identifier of its payload.
enum class MessageKind : std::uint8_t {
  kUnknown = 0,
  kHello,              // "FHEL"
  kWelcome,            // "FWEL"
  kPing,               // "FPIN"
  kPong,               // "FPON"
  kGoodbye,            // "FBYE"
  kError,              // "FERR"
  kSkeletonOffer,      // "FSKO"
  kSkeletonReply,      // "FSKR"
  kPose,               // "FPOS"
  kSubscribeWeights,   // "FSUW"
  kSubscribePictures,  // "FSUP"
  kUnsubscribe,        // "FUNS"
  kSubscribeReply,     // "FSUR"
  kWeights,            // "FWGT"
  kImage,              // "FIMG"
  kUpdatePictures,     // "FUPP"
  kFrameAck,           // "FACK"
  kSubscribePoses,     // "FSPO"
  kDropped,            // "FDRP"
  kListSubjects,       // "FLSU"
  kSubjects,           // "FSBJ"
};

// Stable lowercase name ("pose"), for counters and logs.
[[nodiscard]] std::string_view MessageKindName(MessageKind kind);

// The four-character file identifier; nullptr for kUnknown.
[[nodiscard]] const char* FileIdentifier(MessageKind kind);

// A message with a valid envelope and an unchecked payload. Points into the caller's bytes.
struct MessageView {
  Header header;
  MessageKind kind = MessageKind::kUnknown;
  std::span<const std::uint8_t> payload;
};

// The first of two decoding steps: checks the envelope and finds the kind. Cheap enough to reject
// garbage as fast as it arrives. `bytes` is one whole message (a datagram, a reassembled message or
// a TCP frame) of at most `max_bytes`. Decode() (codec.h) is the second step.
[[nodiscard]] DecodeStatus OpenMessage(std::span<const std::uint8_t> bytes, MessageView& view,
                                       std::size_t max_bytes = kMaxRequestBytes);

// Replaces the contents of `out` with an envelope and a payload that is already encoded: the same
// bytes that Encoder::Encode() writes for the message.
void WriteMessage(const Header& header, std::span<const std::uint8_t> payload,
                  std::vector<std::uint8_t>& out);

}  // namespace furrow::protocol
