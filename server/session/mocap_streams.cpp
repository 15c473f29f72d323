// SPDX-License-Identifier: Apache-2.0
#include "server/session/mocap_streams.h"

#include <chrono>

namespace furrow::server {
namespace {

// VMC and Live Link Face have no authentication and name subjects freely. The limit bounds the map.
constexpr std::size_t kMaxStreams = 64;
constexpr Time kRetryInterval = std::chrono::seconds(1);

}  // namespace

void MocapStreams::OnFrame(Shard& shard, Peer& peer, const protocol::mocap::NeutralFrame& frame,
                           Time now) {
  // Without tracking, the sender repeats an old pose. Ignoring it lets the subject hold and decay.
  // A face alone is offered all the same, so that its state can be shown.
  const bool is_face = frame.joints.empty() && !frame.blend_shapes.empty();
  if (!frame.tracked && !is_face) return;
  Stream* stream = FindOrAdd(peer.id, frame.subject);
  if (stream == nullptr) {
    metrics_->Add(Counter::kMocapRefused);
    return;
  }
  stream->last_frame = now;
  const protocol::Header header{.session = peer.id,
                                .stream = stream->number,
                                .sequence = frame.sequence,
                                .capture_time_us = frame.capture_time_us};
  // Foreign wires have no offers, so the daemon makes one whenever the layout of the frames
  // changes.
  const bool is_new = stream->offered == Time{0};
  const bool retry = stream->rejected && now - stream->offered >= kRetryInterval;
  if (is_new || stream->layout != frame.layout || retry) {
    Offer(shard, peer, header, *stream, frame, now);
  }
  if (stream->rejected) {
    metrics_->Add(Counter::kMocapRefused);
    return;
  }
  if (!frame.tracked) {
    router_->OnNoFace(peer, header, now);
    return;
  }
  // From here on the frame takes the way of any other pose. It has no payload of this wire to
  // relay, so subscribers of poses receive it encoded again.
  protocol::mocap::MakePose(frame, stream->offer, shard.in.pose);
  router_->AcceptPose(shard, peer, header, shard.in.pose, /*payload=*/{}, now);
  // `frame` is reused by the adapter.
  router_->PublishGathered(shard);
}

MocapStreams::Stream* MocapStreams::FindOrAdd(PeerId peer, const std::string& subject) {
  const auto entry = streams_.find({peer, subject});
  if (entry != streams_.end()) return &entry->second;
  if (streams_.size() >= kMaxStreams) return nullptr;
  Stream& added = streams_[{peer, subject}];
  added.number = next_number_++;
  return &added;
}

void MocapStreams::Offer(Shard& shard, Peer& peer, const protocol::Header& header, Stream& stream,
                         const protocol::mocap::NeutralFrame& frame, Time now) {
  // `stream` stays valid while the lock changes hands, because all mocap peers belong to this
  // thread and Tick() runs on it, too.
  const Shards::ExclusiveLock lock(*shards_, shard.index);
  stream.layout = frame.layout;
  stream.offered = now;
  stream.offer = protocol::mocap::MakeOffer(frame);
  stream.rejected = !router_->OnOffer(peer, header, stream.offer, now);
}

void MocapStreams::ForgetSubject(const std::string& name) {
  std::erase_if(streams_, [&name](const auto& entry) { return entry.first.second == name; });
}

void MocapStreams::ForgetRejected(Time now) {
  std::erase_if(streams_, [&](const auto& entry) {
    return entry.second.rejected &&
           now - entry.second.last_frame > FromSeconds(limits_.idle_seconds);
  });
}

}  // namespace furrow::server
