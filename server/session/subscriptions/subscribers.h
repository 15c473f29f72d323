// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocol/messages/messages.h"
#include "render/settings/settings.h"
#include "server/core/limits.h"
#include "server/core/metrics.h"
#include "server/pipeline/picture_source.h"
#include "server/saved/saved_state.h"
#include "server/session/access/access.h"
#include "server/session/delivery/publish_context.h"
#include "server/session/peers/peer.h"
#include "server/session/subjects/places.h"
#include "server/session/subjects/subject_registry.h"
#include "server/session/subscriptions/fan_out.h"
#include "server/session/subscriptions/picture_views.h"
#include "server/session/subscriptions/pose_relay.h"
#include "server/session/subscriptions/subscription.h"
#include "server/session/subscriptions/subscription_table.h"

namespace furrow::server {

// The subscribing half of a session: answers requests and binds subscriptions to subjects
// (STANDARD.md sections 8 and 9). FanOut delivers the frames.
//
// All functions require exclusive access to the hub.
class Subscribers {
 public:
  // `pictures` may be null: this daemon renders nothing. `all_drivers`: evaluate every driver of
  // every subject; else evaluate only those that a subscription needs. `context` is used for
  // replies and for frames sent outside of a pose.
  Subscribers(const Limits& limits, SubjectRegistry* subjects, PictureSource* pictures,
              const render::Settings& settings, bool all_drivers, const Places* places,
              PublishContext* context, Metrics* metrics);
  Subscribers(const Subscribers&) = delete;  // its parts point at each other
  Subscribers& operator=(const Subscribers&) = delete;

  // Replies with SubscribeReply or an error.
  void Subscribe(Peer& peer, const protocol::Header& header,
                 const protocol::SubscribeWeights& request);
  void Subscribe(Peer& peer, const protocol::Header& header,
                 const protocol::SubscribePictures& request);
  void Subscribe(Peer& peer, const protocol::Header& header,
                 const protocol::SubscribePoses& request);
  // Why Subscribe() would refuse this request of a client with this access; nothing: it would not,
  // unless the client has too many subscriptions. Changes nothing.
  [[nodiscard]] std::optional<protocol::ErrorMessage> WhyNoPictures(
      const protocol::SubscribePictures& request, const Access& access);
  // Changes the view of the picture subscription `header.stream`. Replies only to an invalid
  // request, with an error.
  void UpdatePictures(Peer& peer, const protocol::Header& header,
                      const protocol::SubscribePictures& request, Time now);
  // Handles the acknowledgement that the viewer has shown a picture.
  void Acknowledge(Peer& peer, const protocol::Header& header, const protocol::FrameAck& ack,
                   Time now);
  // False: the peer has no such subscription.
  bool Unsubscribe(Peer& peer, std::uint16_t id);

  // Ends the subscriptions that the peer's access does not allow (any more), each with an error.
  void EndForbidden(Peer& peer);
  // Ends all subscriptions of a peer; the second form sends the peer a goodbye for each.
  void RemovePeer(Peer& peer);
  void RemovePeer(Peer& peer, protocol::GoodbyeReason goodbye);

  // The subscriptions of a peer, for another process; nothing if one cannot go there, because it is
  // for pictures.
  [[nodiscard]] std::optional<std::vector<SavedSubscription>> Save(const Peer& peer) const;
  // Subscribes a peer that had these subscriptions at another process. Replies as Subscribe().
  void Resume(Peer& peer, const SavedSubscription& saved);

  // Call after a subject appeared or changed its skeleton or rig. Binds the subscriptions that wait
  // for it, and sends new names or a new skeleton to its subscribers.
  void OnSubjectReady(Subject& subject);
  // Call before a subject is removed. Says goodbye to its subscribers.
  void OnSubjectGone(Subject& subject);
  // Call before a subject that goes on at another node is removed. Sends its subscribers there.
  void OnSubjectMoved(Subject& subject, const NodeAddress& node);
  // Sends subscriptions that wait for a subject to the node that serves it.
  void SendWaitingElsewhere();
  // Evaluates as few drivers of the subject as its subscriptions need.
  void UpdateDriverLevel(Subject& subject);
  // Call after the epoch of the subject has changed. Sends new replies.
  void OnEpoch(Subject& subject);
  // Call after subjects were removed. Binds subscriptions without a subject name to the oldest
  // subject, if there is one.
  void BindWaiting();

  // Sends a finished picture to its viewers.
  void OnPicture(const FinishedPicture& picture, Time now) { pictures_.OnPicture(picture, now); }

  // The daemon's settings for pictures; a view may override some of them.
  [[nodiscard]] const render::Settings& own_settings() const { return pictures_.own_settings(); }
  void SetOwnSettings(const render::Settings& settings, Time now);
  // Call after the limits of the constructor have changed.
  void OnLimits();
  // Changes `all_drivers` of the constructor.
  void SetAllDrivers(bool all_drivers);

  [[nodiscard]] FanOut& fan_out() { return fan_out_; }
  [[nodiscard]] std::size_t size() const { return table_.size(); }

 private:
  bool CheckRequest(Peer& peer, const protocol::Header& header);
  // What a new subscription is for.
  struct Aim {
    Subject* subject = nullptr;  // null without a refusal: the subscription waits
    std::optional<protocol::ErrorMessage> refusal;
    std::optional<NodeAddress> elsewhere;  // with a refusal: the node that serves the subject
  };

  [[nodiscard]] std::optional<protocol::ErrorMessage> MakePictures(
      const protocol::SubscribePictures& request, PictureRequest* pictures);
  [[nodiscard]] Aim FindAim(const Subscription& subscription, const Access& access) const;
  [[nodiscard]] std::string NoSubjectText(const std::string& name, const Access& access) const;
  void ReplyAgain(Subscription& subscription);
  void Add(Peer& peer, const protocol::Header& header, std::unique_ptr<Subscription> subscription);
  bool Bind(Subscription& subscription, Subject& subject);
  bool BindPoses(Subscription& subscription, PoseRequest& request, Subject& subject);
  void Attach(Subscription& subscription, Subject& subject);
  void SendNow(Subscription& subscription, Time now);
  void Reply(const Subscription& subscription, std::vector<std::string> names);
  void RefuseRequest(Peer& peer, const protocol::Header& header, protocol::ErrorCode code,
                     std::string why);
  void RefuseAndErase(Subscription& subscription, protocol::ErrorCode code, std::string why);
  void SendElsewhere(Subscription& subscription, const NodeAddress& node);
  void Erase(Subscription& subscription);

  const Limits& limits_;  // of the hub, which may change them
  SubjectRegistry* const subjects_;
  bool all_drivers_;
  const Places* const places_;
  MessageSender* const messages_;
  Metrics* const metrics_;
  SubscriptionTable table_;
  PoseRelay poses_;
  PictureViews pictures_;
  FanOut fan_out_;
};

}  // namespace furrow::server
