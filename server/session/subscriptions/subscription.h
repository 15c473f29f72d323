// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "protocol/messages/messages.h"
#include "server/pipeline/render_mailbox.h"
#include "server/session/peers/peer.h"
#include "server/session/subjects/subject_registry.h"
#include "server/session/subscriptions/rate_gate.h"
#include "server/session/subscriptions/video_flow.h"
#include "server/session/subscriptions/viewer_flow.h"

namespace furrow::server {

// A subscription to weights, selected by a name pattern. Bind() resolves the pattern against the
// rig of the subject.
struct WeightsRequest {
  std::string pattern;
  protocol::WeightFormat format = protocol::WeightFormat::kF32;
  protocol::WeightSource source = protocol::WeightSource::kWrinkleWeights;
  std::vector<std::uint32_t> indices;  // matching values, in the order of the binding
  std::uint64_t names_hash = 0;        // of the matching names
  std::size_t num_drivers = 0;         // leading drivers of the rig that the values depend on

  // All names of `source`, matching or not.
  [[nodiscard]] std::span<const std::string> Names(const wrinkle::RigBinding& binding) const;
  // Selects the matching names and returns them. The list may exceed the limits of the wire.
  std::vector<std::string> Bind(const wrinkle::RigBinding& binding);
};

// A subscription to pictures.
struct PictureRequest {
  PictureSpec spec;
  Encoding encoding;                   // JPEG with flow control: the tier replaces the quality
  std::vector<std::string> overrides;  // "name=value" on top of the daemon's settings
  std::uint32_t view_request = 0;      // sequence of the message that set this view
  Time changed{0};                     // when the view was set
  std::optional<ViewerFlow> flow;      // flow control; only for viewers that acknowledge
  bool wants_video = false;            // the viewer decodes H.264 and asks for JPEG
  std::optional<VideoFlow> video;      // with flow control and wants_video
};

// A subscription to the skeleton and poses of a subject.
struct PoseRequest {
  // The publisher and skeleton last sent to the peer; 0: none yet.
  std::uint64_t publisher = 0;
  std::uint64_t skeleton_hash = 0;
};

// One subscription of one peer, with its delivery state.
struct Subscription {
  std::uint64_t uid = 0;              // unique for the life of the daemon
  Peer* peer = nullptr;               // outlives the subscription
  std::uint16_t id = 0;               // the number that the peer knows; never 0
  std::uint64_t request_session = 0;  // with `request_sequence`: identifies a repeated request
  std::uint32_t request_sequence = 0;
  std::string subject_name;    // as requested; empty: the oldest subject
  bool wait = false;           // stay when the subject is absent
  Subject* subject = nullptr;  // null: waiting for the subject
  RateGate gate;
  // The newest pose was skipped and the next tick must send it.
  bool owed = false;
  bool held_back = false;  // the peer is stuck and its queued frames were dropped
  std::variant<WeightsRequest, PictureRequest, PoseRequest> request;
  bool every = false;         // not over UDP: newer frames never replace older ones
  std::uint64_t dropped = 0;  // frames lost, and the count last reported to the peer
  std::uint64_t reported_dropped = 0;
  Time reported{0};
};

}  // namespace furrow::server
