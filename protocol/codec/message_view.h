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
  kSubjectState,       // "FSST"
  kDrain,              // "FDRN"
  kDrainState,         // "FDRS"
};

// Stable lowercase name ("pose"), for counters and logs.
[[nodiscard]] std::string_view MessageKindName(MessageKind kind);

// The four-character file identifier; nullptr for kUnknown.
[[nodiscard]] const char* FileIdentifier(MessageKind kind);

// A message with a valid envelope and an unchecked payload. `payload` points into the bytes given
// to OpenMessage(), which must outlive the view.
struct MessageView {
  Header header;
  MessageKind kind = MessageKind::kUnknown;
  std::span<const std::uint8_t> payload;
};

// Checks the envelope of a message and finds the kind: the first of two decoding steps. Cheap
// enough to reject garbage as fast as it arrives. `bytes` is one complete message (a datagram, a
// reassembled message or a TCP frame); more than `max_bytes` is kBadLength. On kOk, pass `view` to
// Decode() (codec.h). On kUnknownKind all of `view` is valid too; otherwise `view` is unspecified.
[[nodiscard]] DecodeStatus OpenMessage(std::span<const std::uint8_t> bytes, MessageView& view,
                                       std::size_t max_bytes = kMaxRequestBytes);

// Replaces the content of `out` with a complete message: the envelope for `header` and a copy of
// `payload`, the FlatBuffers buffer of an encoded message.
void WriteMessage(const Header& header, std::span<const std::uint8_t> payload,
                  std::vector<std::uint8_t>& out);

}  // namespace furrow::protocol
