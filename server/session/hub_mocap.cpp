// SPDX-License-Identifier: Apache-2.0
// The part of Hub that makes streams of what comes over foreign wires.
#include "server/session/hub.h"

namespace furrow::server {
namespace {

constexpr std::size_t kMaxMocapStreams = 64;
constexpr Time kMocapRetry = std::chrono::seconds(1);

}  // namespace

void Hub::OnMocapFrame(PeerId id, const protocol::mocap::NeutralFrame& frame, Time now) {
  Lane& lane = LaneOf(id);
  const Turn turn(*this, lane.index);
  Peer* peer = lane.peers.Find(id);
  // Lost by its own tracker: as if nothing had come, so that it holds and decays.
  if (peer == nullptr || !frame.tracked) return;
  MocapStream* stream = FindOrAddMocap(*peer, frame.subject);
  if (stream == nullptr) {
    metrics_->Add(Counter::kMocapRefused);
    return;
  }
  stream->heard = now;
  const protocol::Header header{.session = id,
                                .stream = stream->stream,
                                .sequence = frame.sequence,
                                .capture_time_us = frame.capture_time_us};
  const bool is_new = stream->offered == Time{0};
  if (is_new || stream->layout != frame.layout ||
      (stream->refused && now - stream->offered >= kMocapRetry)) {
    const Alone alone(*this, lane.index);
    stream->refused = !OfferMocap(*peer, header, *stream, frame, now);
  }
  if (stream->refused) {
    metrics_->Add(Counter::kMocapRefused);
    return;
  }
  protocol::mocap::MakePose(frame, stream->offer, lane.in.pose);
  OnPose(lane, *peer, header, lane.in.pose, {}, now);
  PublishGathered(lane);
}

Hub::MocapStream* Hub::FindOrAddMocap(const Peer& peer, const std::string& subject) {
  const auto entry = mocap_streams_.find({peer.id, subject});
  if (entry != mocap_streams_.end()) return &entry->second;
  if (mocap_streams_.size() >= kMaxMocapStreams) return nullptr;
  MocapStream& added = mocap_streams_[{peer.id, subject}];
  added.stream = next_mocap_stream_++;
  return &added;
}

// Those that were taken go with their subject; a refused one has none.
void Hub::ForgetRefusedMocap(Time now) {
  std::erase_if(mocap_streams_, [&](const auto& entry) {
    return entry.second.refused && now - entry.second.heard > FromSeconds(limits_.idle_seconds);
  });
}

bool Hub::OfferMocap(Peer& peer, const protocol::Header& header, MocapStream& stream,
                     const protocol::mocap::NeutralFrame& frame, Time now) {
  stream.layout = frame.layout;
  stream.offered = now;
  stream.offer = protocol::mocap::MakeOffer(frame);
  return OnOffer(peer, header, stream.offer, now);
}

}  // namespace furrow::server
