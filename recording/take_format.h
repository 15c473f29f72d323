// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "protocol/codec/codec.h"

// How a take lies in an MCAP file; docs/RECORDING.md is the same for people.
namespace furrow::recording {

// What a message of a take is. All but the last carry the FlatBuffers payload of a wire message,
// without its envelope.
enum class TakeKind : std::uint8_t {
  kSkeleton = 0,  // "/<subject>/skeleton": SkeletonOffer
  kPose,          // "/<subject>/pose": Pose
  kNames,         // "/<subject>/names": SubscribeReply, what the values of Weights are called
  kWeights,       // "/<subject>/weights": Weights
  kDatagram,      // "/raw/udp": where a datagram came from, then the datagram
};
inline constexpr int kNumTakeKinds = 5;

// When, and from which run of a sender: what the envelope said, and the moment it came.
struct TakeStamp {
  std::uint64_t session = 0;         // the channel's metadata "session"
  std::uint32_t sequence = 0;        // of the pose; MCAP's sequence
  std::int64_t capture_time_us = 0;  // on the sender's clock; MCAP's publish time
  std::uint64_t log_time_ns = 0;     // when it came, since the Unix epoch; MCAP's log time
};

// A datagram's sender: IPv6 address (or mapped IPv4) and port, both in network order.
using DatagramSender = std::array<std::uint8_t, 18>;

inline constexpr char kTakeProfile[] = "furrow-take";
inline constexpr char kFlatBufferEncoding[] = "flatbuffer";
inline constexpr char kDatagramEncoding[] = "furrow-datagram";
inline constexpr char kDatagramTopic[] = "/raw/udp";
inline constexpr char kRigAttachment[] = "rig.json";

// The topic of a subject's messages of a kind.
[[nodiscard]] std::string TopicOf(TakeKind kind, std::string_view subject);
// Back from a topic; false where it is none of ours. The subject may contain slashes.
[[nodiscard]] bool ParseTopic(std::string_view topic, TakeKind* kind, std::string* subject);

// The name of the FlatBuffers table and the binary schema (.bfbs) of a kind's messages; both empty
// for datagrams.
[[nodiscard]] std::string_view SchemaName(TakeKind kind);
[[nodiscard]] std::span<const std::uint8_t> BinarySchema(TakeKind kind);

// Which wire message a kind's payload is; kUnknown for datagrams.
[[nodiscard]] protocol::MessageKind MessageKindOf(TakeKind kind);

// How long the wire's messages of a kind are at most: those of publishers, and the server's.
[[nodiscard]] std::size_t MaxPayloadBytes(TakeKind kind);

// The wire's microseconds as MCAP's nanoseconds and back: two's complement, so that clocks with any
// epoch survive; a clock further than 292 years from its epoch is held at that.
[[nodiscard]] std::uint64_t ToPublishTime(std::int64_t capture_time_us);
[[nodiscard]] std::int64_t FromPublishTime(std::uint64_t publish_time_ns);

}  // namespace furrow::recording
