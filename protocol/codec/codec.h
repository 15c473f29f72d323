// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "protocol/framing/envelope.h"
#include "protocol/messages/messages.h"

namespace furrow::protocol {

// What a message is: the FlatBuffers file identifier of its payload.
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

// Why bytes were refused. For counters; the order is the order of the checks, cheapest first.
enum class DecodeStatus : std::uint8_t {
  kOk = 0,
  kTooShort,
  kBadMagic,
  kBadVersion,
  kBadFlags,  // undefined flags, or a fragment or bundle where a whole message is due
  kBadSession,
  kBadLength,    // payload size and byte count differ, or exceed the limit of the transport
  kUnknownKind,  // no such file identifier (a newer peer: ignore it)
  kWrongKind,    // Decode() into another message's struct
  kUnverified,   // FlatBuffers' verifier said no
  kMissingField,
  kBadCount,   // counts that contradict each other, or unordered indices
  kLimit,      // more joints, names or characters than limits.h allows
  kNonFinite,  // NaN or infinity
  kNotUnit,    // a quaternion further than 1e-3 from unit length
  kBadValue,   // an unknown enum value or a number out of its range
  kBadText,    // not UTF-8, empty or twice where that is not allowed
  kBadHash,    // an offer or name table that does not hash to what it says
};
inline constexpr int kNumDecodeStatuses = static_cast<int>(DecodeStatus::kBadHash) + 1;

// Stable lower-case names ("bad_magic", "pose"), for counters and logs.
[[nodiscard]] std::string_view DecodeStatusName(DecodeStatus status);
[[nodiscard]] std::string_view MessageKindName(MessageKind kind);

// A message whose envelope was checked, its payload not yet. Points into the caller's bytes.
struct MessageView {
  Header header;
  MessageKind kind = MessageKind::kUnknown;
  std::span<const std::uint8_t> payload;
};

// First step: envelope and kind; cheap enough for garbage at line rate. `bytes` is one whole
// message (a datagram, a reassembled message or a TCP frame) of at most `max_bytes`.
[[nodiscard]] DecodeStatus OpenMessage(std::span<const std::uint8_t> bytes, MessageView& view,
                                       std::size_t max_bytes = kMaxRequestBytes);

// Second step: verify, check and copy. On failure `message` is unspecified but safe to reuse.
// Never throws, never reads beyond the payload, needs no alignment; does not allocate once
// `message` has grown (PoseFrame, WeightFrame, ImageFrame). Safe to call from any thread.
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

// An envelope before a payload that is encoded already: what Encode() would have made of it.
void WriteMessage(const Header& header, std::span<const std::uint8_t> payload,
                  std::vector<std::uint8_t>& out);

// How a pose is written.
struct PoseEncoding {
  bool quantise_rotations = false;     // 6 bytes a joint, off by at most 1.5e-4 rad (quantise.h)
  bool quantise_translations = false;  // 6 bytes, off by at most largest offset / 65534 an axis
  bool quantise_blend_shapes = false;  // 2 bytes, clamped to (-2, 2), off by at most 1/32768
  [[nodiscard]] static PoseEncoding Small() { return {true, true, true}; }
};

// Writes messages. Keeps its working memory: one a thread,
// reused, does not allocate in the long run.
//
// Encode() replaces the content of `out` by envelope and payload: what goes
// into one TCP frame, one datagram, or fragments (fragment.h). Precondition:
// the message would pass Decode(); lists of indices may be left empty to
// mean "all, in order" when their values are as many as the skeleton's.
class Encoder {
 public:
  Encoder();
  ~Encoder();
  Encoder(Encoder&&) noexcept;
  Encoder& operator=(Encoder&&) noexcept;

  void Encode(const Header& header, const Hello& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const Welcome& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const Ping& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const Pong& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const Goodbye& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const ErrorMessage& message, std::vector<std::uint8_t>& out);
  // Computes and writes the hash itself; message.skeleton_hash is not read.
  void Encode(const Header& header, const SkeletonOffer& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const SkeletonReply& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const PoseFrame& message, std::vector<std::uint8_t>& out,
              const PoseEncoding& encoding = {});
  void Encode(const Header& header, const SubscribeWeights& message,
              std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const SubscribePictures& message,
              std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const Unsubscribe& message, std::vector<std::uint8_t>& out);
  // Computes and writes the names' hash itself (0 without names).
  void Encode(const Header& header, const SubscribeReply& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const WeightFrame& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const ImageFrame& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const UpdatePictures& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const FrameAck& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const SubscribePoses& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const Dropped& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const ListSubjects& message, std::vector<std::uint8_t>& out);
  void Encode(const Header& header, const Subjects& message, std::vector<std::uint8_t>& out);

  struct State;  // defined where FlatBuffers is known

 private:
  std::unique_ptr<State> state_;
};

}  // namespace furrow::protocol
