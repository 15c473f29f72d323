// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "protocol/messages/cluster_messages.h"
#include "server/core/time.h"
#include "server/saved/saved_state.h"
#include "server/session/peers/peer.h"
#include "server/session/shards.h"
#include "server/session/stream_router.h"
#include "server/session/subjects/subject_registry.h"
#include "server/session/subscriptions/subscribers.h"

namespace furrow::server {

// The hub's part of a restart: saves peers and subjects for the daemon that takes the place of this
// one, and goes on with those of the former one. A subject moves as to another node of a cluster,
// by its offer and its state. All functions require the hub's exclusive lock.
class Restart {
 public:
  // Not null, and outlive this object.
  struct Parts {
    SubjectRegistry* subjects = nullptr;
    Subscribers* subscribers = nullptr;
    StreamRouter* router = nullptr;
    Shards* shards = nullptr;
    // Takes over the captured poses of a subject that goes on here.
    std::function<void(const protocol::SubjectState& state, Time now)> adopt_captures;
  };
  explicit Restart(Parts parts) : parts_(std::move(parts)) {}

  // Those of Hub.
  [[nodiscard]] bool MaySave(const Peer& peer) const;
  [[nodiscard]] std::optional<SavedPeer> Save(Peer& peer) const;
  [[nodiscard]] std::vector<SavedSubject> SaveSubjects(Time now);
  // `owner`: null if its publisher is not here.
  void Resume(const SavedSubject& saved, Peer* owner, Time away, Time now);
  // `away`: how long nobody has served the peer.
  void Resume(Peer& peer, const SavedPeer& saved, Time away);

 private:
  const Parts parts_;
};

}  // namespace furrow::server
