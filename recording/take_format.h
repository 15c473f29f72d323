// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "protocol/codec/codec.h"

// The layout of a take in an MCAP file. docs/RECORDING.md documents it for users.
namespace furrow::recording {

// The kinds of messages in a take. All except kDatagram carry the FlatBuffers payload of a wire
// message, without its envelope.
enum class TakeKind : std::uint8_t {
  kSkeleton = 0,  // "/<subject>/skeleton": SkeletonOffer
  kPose,          // "/<subject>/pose": Pose
  kNames,         // "/<subject>/names": SubscribeReply, the names of the values in Weights
  kWeights,       // "/<subject>/weights": Weights
  kDatagram,      // "/raw/udp": the sender's address and the datagram
};
inline constexpr int kNumTakeKinds = 5;

// The envelope of a wire message, and the time when the daemon received it.
struct TakeStamp {
  std::uint64_t session = 0;         // the run of a sender; channel metadata "session"
  std::uint32_t sequence = 0;        // of the pose; stored as MCAP's sequence
  std::int64_t capture_time_us = 0;  // sender's clock; stored as MCAP's publish time
  std::uint64_t log_time_ns = 0;     // arrival, since the Unix epoch; MCAP's log time
};

// A datagram's sender: an IPv6 address (or mapped IPv4) and a port, both in network order.
using DatagramSender = std::array<std::uint8_t, 18>;

inline constexpr char kTakeProfile[] = "furrow-take";
inline constexpr char kFlatBufferEncoding[] = "flatbuffer";
inline constexpr char kDatagramEncoding[] = "furrow-datagram";
inline constexpr char kDatagramTopic[] = "/raw/udp";
inline constexpr char kRigAttachment[] = "rig.json";

// The topic of a subject's messages of a kind, as listed at TakeKind.
[[nodiscard]] std::string TopicOf(TakeKind kind, std::string_view subject);
// Splits a topic into kind and subject, which may contain slashes. Returns false for topics of
// other programs; the results are then unspecified.
[[nodiscard]] bool ParseTopic(std::string_view topic, TakeKind* kind, std::string* subject);

// The name of the FlatBuffers table and the binary schema (.bfbs) of a kind's messages. Both are
// empty for datagrams.
[[nodiscard]] std::string_view SchemaName(TakeKind kind);
[[nodiscard]] std::span<const std::uint8_t> BinarySchema(TakeKind kind);

// The wire message that a kind's payload holds; kUnknown for datagrams.
[[nodiscard]] protocol::MessageKind MessageKindOf(TakeKind kind);

// The maximum payload of a kind in bytes: the wire's limit for the messages of its sender.
[[nodiscard]] std::size_t MaxPayloadBytes(TakeKind kind);

// Converts the wire's microseconds to MCAP's nanoseconds and back. The value is stored as two's
// complement, so negative times survive. Times more than 292 years from the epoch are clamped.
[[nodiscard]] std::uint64_t ToPublishTime(std::int64_t capture_time_us);
[[nodiscard]] std::int64_t FromPublishTime(std::uint64_t publish_time_ns);

}  // namespace furrow::recording
