// SPDX-License-Identifier: Apache-2.0
#include "recording/take_format.h"

#include <algorithm>
#include <limits>

#include <pose_bfbs.h>
#include <skeleton_offer_bfbs.h>
#include <subscribe_reply_bfbs.h>
#include <weights_bfbs.h>

#include "protocol/messages/limits.h"

namespace furrow::recording {
namespace {

using protocol::MessageKind;

struct KindRow {
  std::string_view topic;  // the last part of the topic
  std::string_view schema;
  std::span<const std::uint8_t> binary;
  MessageKind message;
};

const KindRow& RowOf(TakeKind kind) {
  static const std::array<KindRow, kNumTakeKinds> rows{
      {{"skeleton", "furrow.protocol.wire.SkeletonOffer", k_skeleton_offer_bfbs,
        MessageKind::kSkeletonOffer},
       {"pose", "furrow.protocol.wire.Pose", k_pose_bfbs, MessageKind::kPose},
       {"names", "furrow.protocol.wire.SubscribeReply", k_subscribe_reply_bfbs,
        MessageKind::kSubscribeReply},
       {"weights", "furrow.protocol.wire.Weights", k_weights_bfbs, MessageKind::kWeights},
       {"udp", "", {}, MessageKind::kUnknown}}};
  return rows[static_cast<std::size_t>(kind)];
}

}  // namespace

std::string TopicOf(TakeKind kind, std::string_view subject) {
  if (kind == TakeKind::kDatagram) return kDatagramTopic;
  return "/" + std::string(subject) + "/" + std::string(RowOf(kind).topic);
}

bool ParseTopic(std::string_view topic, TakeKind* kind, std::string* subject) {
  if (topic == kDatagramTopic) {
    *kind = TakeKind::kDatagram;
    subject->clear();
    return true;
  }
  // The last slash, because subjects may contain slashes.
  const std::size_t slash = topic.rfind('/');
  if (slash == std::string_view::npos || slash < 2 || topic.front() != '/') return false;
  // In the order of TakeKind, without the datagrams.
  for (int i = 0; i < static_cast<int>(TakeKind::kDatagram); ++i) {
    if (RowOf(static_cast<TakeKind>(i)).topic != topic.substr(slash + 1)) continue;
    *kind = static_cast<TakeKind>(i);
    *subject = topic.substr(1, slash - 1);
    return true;
  }
  return false;
}

std::string_view SchemaName(TakeKind kind) { return RowOf(kind).schema; }
std::span<const std::uint8_t> BinarySchema(TakeKind kind) { return RowOf(kind).binary; }
MessageKind MessageKindOf(TakeKind kind) { return RowOf(kind).message; }

std::size_t MaxPayloadBytes(TakeKind kind) {
  const bool is_reply = kind == TakeKind::kNames || kind == TakeKind::kWeights;
  return is_reply ? protocol::kMaxReplyBytes : protocol::kMaxRequestBytes;
}

std::uint64_t ToPublishTime(std::int64_t capture_time_us) {
  // Clamped before the product, which would overflow.
  constexpr std::int64_t kFurthest = std::numeric_limits<std::int64_t>::max() / 1000;
  return static_cast<std::uint64_t>(std::clamp(capture_time_us, -kFurthest, kFurthest) * 1000);
}

std::int64_t FromPublishTime(std::uint64_t publish_time_ns) {
  return static_cast<std::int64_t>(publish_time_ns) / 1000;
}

}  // namespace furrow::recording
