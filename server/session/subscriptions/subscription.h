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
#include "server/session/subscriptions/viewer_flow.h"

namespace furrow::server {

// Weights by pattern: which of the binding's values, in their order.
struct WeightsWish {
  std::string pattern;
  protocol::WeightFormat format = protocol::WeightFormat::kF32;
  protocol::WeightSource source = protocol::WeightSource::kWrinkleWeights;
  std::vector<std::uint32_t> indices;  // of the bound subject's names that match
  std::uint64_t names_hash = 0;
  std::size_t num_drivers = 0;  // of the rig, in its order, that they come from

  // All names this wish picks from.
  [[nodiscard]] std::span<const std::string> Names(const wrinkle::RigBinding& binding) const;
  // Picks the names that match; returns them, more than the wire carries too.
  std::vector<std::string> Bind(const wrinkle::RigBinding& binding);
};

struct PicturesWish {
  PictureSpec spec;
  Encoding encoding;                   // with flow control and JPEG, its tier decides
  std::vector<std::string> overrides;  // of the daemon's settings, "name=value"
  std::uint32_t view_request = 0;      // who asked for this view: a request's sequence
  Time changed{0};                     // when the view became this one
  std::optional<ViewerFlow> flow;      // none: not acknowledged
};

// Skeleton and poses as they were used.
struct PosesWish {
  // Who and what the peer was told last; 0: nobody.
  std::uint64_t publisher = 0;
  std::uint64_t skeleton_hash = 0;
};

// What one peer asked for, and when it is next due.
struct Subscription {
  std::uint64_t uid = 0;      // never used twice in a run
  Peer* peer = nullptr;       // outlives the subscription
  std::uint16_t id = 0;       // the peer's name for it; never 0
  std::uint64_t session = 0;  // with `request`: tells a repeated request from a new one
  std::uint32_t request = 0;
  std::string subject_name;  // as asked; empty: whoever has been there longest
  bool wait = false;
  Subject* subject = nullptr;  // null: waiting
  RateGate gate;
  // The newest pose was left out, for its rate or a stuck peer, and nothing newer has come.
  bool owed = false;
  bool held_back = false;  // the peer is stuck, and nothing of this waits for it
  std::variant<WeightsWish, PicturesWish, PosesWish> wish;
  bool every = false;         // TCP: nothing gives way to newer frames
  std::uint64_t dropped = 0;  // of every: frames left out, and how many the peer was told of
  std::uint64_t told_dropped = 0;
  Time told{0};
};

}  // namespace furrow::server
