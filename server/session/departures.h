// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "server/cluster/place.h"
#include "server/core/time.h"
#include "server/session/delivery/message_sender.h"
#include "server/session/shards.h"
#include "server/session/stream_router.h"
#include "server/session/subjects/places.h"
#include "server/session/subjects/publishers.h"
#include "server/session/subjects/subject_registry.h"
#include "server/session/subscriptions/subscribers.h"

namespace furrow::server {

// Sends subjects to other nodes of the cluster, together with their publishers and subscribers. All
// functions require the hub's exclusive lock.
class Departures {
 public:
  // Not null, and outlive this object.
  struct Parts {
    Places* places = nullptr;
    SubjectRegistry* subjects = nullptr;
    Publishers* publishers = nullptr;
    Subscribers* subscribers = nullptr;
    StreamRouter* router = nullptr;
    Shards* shards = nullptr;
    MessageSender* messages = nullptr;
    std::function<void(Subject& subject)> remove;  // forgets a subject that has left
  };
  explicit Departures(Parts parts) : parts_(std::move(parts)) {}

  // Those of Hub.
  [[nodiscard]] Place SuccessorOf(std::string_view subject, Time now,
                                  const std::set<std::string>& without);
  [[nodiscard]] bool WriteState(std::string_view subject, std::uint32_t number,
                                std::vector<std::uint8_t>& message);
  [[nodiscard]] Status HandOver(std::string_view subject, const NodeAddress& node,
                                std::uint32_t number, std::vector<std::uint8_t>& message, Time now);

  // Asks again for the places of all subjects. A subject that another node serves by now leaves.
  // One without a place stays: the node may get it back, and its publisher goes on.
  void RenewPlaces(Time now);
  // Sends everybody to other nodes where there are any, and gives all places back.
  void SendAllAway(Time now);

 private:
  [[nodiscard]] Peer* OwnerOf(const Subject& subject) {
    return parts_.shards->FindPeer(subject.owner.peer);
  }
  [[nodiscard]] std::string WhyItStays(const Subject& subject, Time now);
  void Move(Subject& subject, const NodeAddress& node);

  const Parts parts_;
};

}  // namespace furrow::server
