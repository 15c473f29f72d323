// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "protocol/codec/decode_status.h"
#include "protocol/codec/message_view.h"
#include "protocol/messages/cluster_messages.h"
#include "protocol/messages/messages.h"
#include "protocol/messages/quantise.h"

// Encodes and decodes every message of the wire. This header is all that callers need.
//
// How the folder is built: decode_status.h lists the reasons of a rejection, message_view.h reads
// envelopes. Each *_message(s).h converts some messages between our structs and their FlatBuffers
// tables, with the checks of wire_fields.h. codec.cpp maps each struct to its table.
namespace furrow::protocol {

// Verifies the payload of a message that OpenMessage() accepted, checks every field, and copies
// them to `message`. On failure `message` has unspecified values but may be reused.
//
// Never throws and never reads beyond the payload. The payload may have any alignment. PoseFrame,
// WeightFrame and ImageFrame do not allocate once `message` has grown. Safe to call on any thread.
[[nodiscard]] DecodeStatus Decode(const MessageView& view, Hello& message);
[[nodiscard]] DecodeStatus Decode(const MessageView& view, Welcome& message);
[[nodiscard]] DecodeStatus Decode(const MessageView& view, Ping& message);
[[nodiscard]] DecodeStatus Decode(const MessageView& view, Pong& message);
[[nodiscard]] DecodeStatus Decode(const MessageView& view, Goodbye& message);
[[nodiscard]] DecodeStatus Decode(const MessageView& view, ErrorMessage& message);
[[nodiscard]] DecodeStatus Decode(const MessageView& view, SkeletonOffer& message);
[[nodiscard]] DecodeStatus Decode(const MessageView& view, SkeletonReply& message);
[[nodiscard]] DecodeStatus Decode(const MessageView& view, PoseFrame& message);
[[nodiscard]] DecodeStatus Decode(const MessageView& view, SubscribeWeights& message);
[[nodiscard]] DecodeStatus Decode(const MessageView& view, SubscribePictures& message);
[[nodiscard]] DecodeStatus Decode(const MessageView& view, Unsubscribe& message);
[[nodiscard]] DecodeStatus Decode(const MessageView& view, SubscribeReply& message);
[[nodiscard]] DecodeStatus Decode(const MessageView& view, WeightFrame& message);
[[nodiscard]] DecodeStatus Decode(const MessageView& view, ImageFrame& message);
[[nodiscard]] DecodeStatus Decode(const MessageView& view, UpdatePictures& message);
[[nodiscard]] DecodeStatus Decode(const MessageView& view, FrameAck& message);
[[nodiscard]] DecodeStatus Decode(const MessageView& view, SubscribePoses& message);
[[nodiscard]] DecodeStatus Decode(const MessageView& view, Dropped& message);
[[nodiscard]] DecodeStatus Decode(const MessageView& view, ListSubjects& message);
[[nodiscard]] DecodeStatus Decode(const MessageView& view, Subjects& message);
[[nodiscard]] DecodeStatus Decode(const MessageView& view, SubjectState& message);
[[nodiscard]] DecodeStatus Decode(const MessageView& view, Drain& message);
[[nodiscard]] DecodeStatus Decode(const MessageView& view, DrainState& message);

// Decodes the pose that `pose` repeats (PoseFrame::previous, which must not be empty). kBadValue:
// it is partial, repeats a pose itself, or is of another skeleton.
[[nodiscard]] DecodeStatus DecodePrevious(const PoseFrame& pose, PoseFrame& previous);

// Encodes messages. Reuse one encoder per thread: it keeps its working memory, so repeated calls
// stop allocating.
//
// Encode() replaces the content of `out` with one complete message: envelope and payload. Send it
// as one TCP frame (tcp_framing.h), or as the datagrams that WriteDatagram() cuts (fragment.h).
// Precondition: Decode() would accept the message. A pose's list of indices may be empty although
// its list of values is not; the values then belong to all joints or blend shapes, in order.
class Encoder {
 public:
  Encoder();
  ~Encoder();
  Encoder(Encoder&&) noexcept;
  Encoder& operator=(Encoder&&) noexcept;

  // Pads the message to kHelloBytes (STANDARD.md section 4).
  void Encode(const Header& header, const Hello& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const Welcome& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const Ping& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const Pong& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const Goodbye& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const ErrorMessage& message, std::vector<std::uint8_t>& out);
  // Computes the hash; ignores message.skeleton_hash.
  void Encode(const Header& header, const SkeletonOffer& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const SkeletonReply& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const PoseFrame& message, std::vector<std::uint8_t>& out,
              const PoseEncoding& encoding = {});
  void Encode(const Header& header, const SubscribeWeights& message,
              std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const SubscribePictures& message,
              std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const Unsubscribe& message, std::vector<std::uint8_t>& out);
  // Computes the hash of the names (0 without names); ignores message.names_hash.
  void Encode(const Header& header, const SubscribeReply& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const WeightFrame& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const ImageFrame& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const UpdatePictures& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const FrameAck& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const SubscribePoses& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const Dropped& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const ListSubjects& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const Subjects& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const SubjectState& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const Drain& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const DrainState& message, std::vector<std::uint8_t>& out);

 private:
  struct State;  // holds FlatBuffers types, which this header hides
  std::unique_ptr<State> state_;
};

}  // namespace furrow::protocol
