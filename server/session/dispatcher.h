// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>

#include "protocol/codec/codec.h"
#include "protocol/messages/messages.h"
#include "server/core/limits.h"
#include "server/core/metrics.h"
#include "server/core/time.h"
#include "server/session/access/refusal_log.h"
#include "server/session/access/token_gate.h"
#include "server/session/delivery/message_sender.h"
#include "server/session/peers/peer.h"
#include "server/session/shards.h"
#include "server/session/stream_router.h"
#include "server/session/subjects/arrivals.h"
#include "server/session/subjects/places.h"
#include "server/session/subjects/publishers.h"
#include "server/session/subjects/subject_registry.h"
#include "server/session/subscriptions/subscribers.h"

namespace furrow::server {

// Verifies and decodes messages and passes each on by its kind: poses to the StreamRouter, offers
// to Publishers, requests to Subscribers. Answers messages about the connection itself (Hello,
// Ping, ListSubjects). A peer that has shown no token where one is required gets one error and is
// cut off (STANDARD.md section 4). Invalid messages are counted and, except over UDP, answered with
// an error.
class Dispatcher {
 public:
  // All pointers are not null, unless they say otherwise, and outlive the dispatcher.
  struct Parts {
    Shards* shards = nullptr;
    StreamRouter* router = nullptr;
    Publishers* publishers = nullptr;
    Subscribers* subscribers = nullptr;
    SubjectRegistry* subjects = nullptr;
    MessageSender* messages = nullptr;  // used under the exclusive lock
    Metrics* metrics = nullptr;
    const TokenGate* gate = nullptr;  // null: everybody may do everything
    Places* places = nullptr;
    Arrivals* arrivals = nullptr;
    const Limits* limits = nullptr;
    std::function<protocol::DrainState(bool begin)> drain;  // Hub::Parts::drain
    // Hub::Parts::is_own_address; empty: none is
    std::function<bool(const std::string& address)> is_own_address;
    // Adds the reference poses of a subject that arrives to the rig.
    std::function<void(const protocol::SubjectState& state, Time now)> adopt_captures;
  };
  explicit Dispatcher(Parts parts) : parts_(std::move(parts)) {}

  // Handles one whole message of `peer`. The caller holds the shard's lock. Only poses run under
  // that lock alone; other messages take the exclusive lock. A pose may stay in the shard's batch,
  // so `bytes` must stay valid until StreamRouter::PublishGathered().
  void Dispatch(Shard& shard, Peer& peer, std::span<const std::uint8_t> bytes, Time now);

  // Sends the list of subjects to a peer that follows it, if the list has changed since the last
  // one. Requires the exclusive lock.
  void UpdateSubjectList(Peer& peer);
  // Tells a peer that it must show a token, and cuts it off. Requires the lock of its shard.
  void RefuseStranger(Peer& peer);
  // Ends a peer whose token is missing, refused or has ended: its connection closes after what is
  // queued, and further messages have no effect. `soon`: it need not have read that. Requires the
  // lock of its shard.
  void CutOff(Peer& peer, bool soon = false);
  // Makes the dispatcher refuse all further subscriptions, because the daemon shuts down. Requires
  // the exclusive lock.
  void RefuseSubscriptions() { refuses_subscriptions_ = true; }

 private:
  void DispatchVerified(Shard& shard, Peer& peer, const protocol::MessageView& view, Time now);
  void RecoverPrevious(Shard& shard, const Peer& peer, const protocol::Header& header, Time now);
  [[nodiscard]] bool TakeRequest(Shard& shard, Peer& peer, const protocol::MessageView& view,
                                 Time now);
  void DispatchExclusive(Shard& shard, Peer& peer, const protocol::MessageView& view, Time now);
  void DispatchRequest(Shard& shard, Peer& peer, const protocol::MessageView& view, Time now);
  template <class Request>
  void Subscribe(Shard& shard, Peer& peer, const protocol::MessageView& view, Request& request);
  template <class Message, class Handler>
  void Decode(Shard& shard, Peer& peer, const protocol::MessageView& view, Message& message,
              const Handler& handler);
  void RejectEnvelope(Shard& shard, Peer& peer, const protocol::MessageView& view,
                      protocol::DecodeStatus status);
  void OnHello(Peer& peer, const protocol::Header& header, const protocol::Hello& hello, Time now);
  bool OnToken(Peer& peer, const protocol::Header& header, const std::string& token, Time now);
  [[nodiscard]] const char* WhyNeeded(const Peer& peer) const;
  void RefuseStranger(Shard& shard, Peer& peer, const protocol::Header& header, std::string why);
  void Refuse(Shard& shard, Peer& peer, const protocol::Header& header, std::string why);
  void OnListSubjects(Peer& peer, const protocol::Header& header,
                      const protocol::ListSubjects& request);
  void OnSubjectState(Peer& peer, const protocol::MessageView& view,
                      const protocol::SubjectState& state, Time now);
  [[nodiscard]] std::string WhyNoDrain(const Peer& peer) const;
  void OnDrain(Peer& peer, const protocol::Header& header, const protocol::Drain& request);
  void SendSubjectList(Peer& peer, const protocol::Header& request);

  const Parts parts_;
  bool refuses_subscriptions_ = false;
  RefusalLog refusals_;
};

}  // namespace furrow::server
