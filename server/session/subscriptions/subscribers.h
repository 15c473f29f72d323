// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "protocol/messages/messages.h"
#include "server/config/config.h"
#include "server/core/metrics.h"
#include "server/pipeline/picture_source.h"
#include "server/session/delivery/desk.h"
#include "server/session/peers/peer.h"
#include "server/session/subjects/subject_registry.h"
#include "server/session/subscriptions/subscription.h"
#include "server/session/subscriptions/view_settings.h"

namespace furrow::server {

// The subscribing half of a daemon: who wants what of whom, and what is due to whom now
// (STANDARD.md sections 8 and 9).
class Subscribers {
 public:
  // `pictures` may be null: nothing is drawn here. `all_drivers`: all weights are used, whoever
  // subscribes; else of each subject only the drivers are evaluated that its subscriptions need.
  Subscribers(const Limits& limits, SubjectRegistry* subjects, PictureSource* pictures,
              const render::Settings& settings, bool all_drivers, Desk* desk, Metrics* metrics);

  // All answer with SubscribeReply or an error.
  void Subscribe(Peer& peer, const protocol::Header& header,
                 const protocol::SubscribeWeights& request);
  void Subscribe(Peer& peer, const protocol::Header& header,
                 const protocol::SubscribePictures& request);
  void Subscribe(Peer& peer, const protocol::Header& header,
                 const protocol::SubscribePoses& request);
  // Another view for the subscription that the header's stream names; an error, or no answer.
  void Update(Peer& peer, const protocol::Header& header,
              const protocol::SubscribePictures& request, Time now);
  // A viewer has shown a picture.
  void Acknowledge(Peer& peer, const protocol::Header& header, std::uint32_t number, Time now);
  // False: the peer has no such subscription.
  bool Unsubscribe(Peer& peer, std::uint16_t id);

  // All of a peer's subscriptions end; with `goodbye` it is told why.
  void RemovePeer(Peer& peer);
  void RemovePeer(Peer& peer, protocol::GoodbyeReason goodbye);

  // A subject has come, or its names may have changed: who waits for it is bound and told.
  void OnSubjectReady(Subject& subject);
  // A subject is about to be removed.
  void OnSubjectGone(Subject& subject);
  // ... and was: who waits for anybody is bound to who has been there longest now, if anybody is.
  void BindWaiting();

  // Sends the subject's weights and pose, and asks for its pictures, wherever they are due. `pose`:
  // the payload that it came as; empty where it does not say the whole pose, or none came.
  // Of different subjects on several threads at once, each at its own desk.
  void Publish(Subject& subject, std::span<const std::uint8_t> pose, std::int64_t age_us, Time now,
               Desk* desk);
  // Sends what a rate held back, so that a pose after which none comes is still seen.
  void PublishOwed(Time now);
  // Hands a finished picture to those it was drawn for, as far as they are still there.
  void OnPicture(const FinishedPicture& picture);

  // The settings of every view that does not say otherwise; what is shown now changes with them.
  [[nodiscard]] const render::Settings& own_settings() const { return settings_.own(); }
  void SetOwnSettings(const render::Settings& settings, Time now);

  [[nodiscard]] std::size_t size() const { return subscriptions_.size(); }

 private:
  using Jobs = Desk::Jobs;

  bool MayAdd(Peer& peer, const protocol::Header& header);
  Subscription* Find(const Peer& peer, std::uint16_t id);
  Subscription* FindRepeated(const Peer& peer, const protocol::Header& header);
  void Add(Peer& peer, const protocol::Header& header, std::unique_ptr<Subscription> subscription);
  void Reply(const Subscription& subscription, std::vector<std::string> names);
  // False: no name matches, or more than an answer holds; the peer is told and it is erased.
  bool Bind(Subscription& subscription, Subject& subject);
  void Refuse(Subscription& subscription, protocol::ErrorCode code, std::string why);
  void Erase(Subscription& subscription);
  std::uint16_t NewId(Peer& peer);

  bool BindPoses(Subscription& subscription, PosesWish& wish, Subject& subject);
  void Attach(Subscription& subscription, Subject& subject);
  void UpdateLevel(Subject& subject);

  void Deliver(Subscription& subscription, std::span<const std::uint8_t> pose, std::int64_t age_us,
               Time now, Desk* desk);
  // Whether the peer is stuck; the newest pose is then owed.
  bool HoldBack(Subscription& subscription);
  void SendPose(Subscription& subscription, std::span<const std::uint8_t> pose, Desk* desk);
  void TellDropped(Subscription& subscription, Time now);
  void SendWeights(Subscription& subscription, const WeightsWish& wish, std::int64_t age_us,
                   Desk* desk);
  static void EncodeWeights(const SubjectPipeline& pipeline, const WeightsWish& wish,
                            std::int64_t age_us, Desk* desk);
  void PublishOwed(Subscription& subscription, Time now);

  // viewers.cpp
  Result<PicturesWish> MakeWish(const protocol::SubscribePictures& request);
  void Show(Subscription& subscription, Time now);
  void ShowChanged(Subscription& subscription, PicturesWish& wish, Time now);
  // Since when pose and view are what they are.
  static Time ShownSince(const Subscription& subscription, const PicturesWish& wish);
  static bool Rests(const Subscription& subscription, const PicturesWish& wish, Time now);
  void AddToJobs(Subscription& subscription, PicturesWish& wish, std::int64_t age_us, Time now,
                 Jobs* jobs);
  void AskForPicture(Subscription& subscription, PicturesWish& wish, std::int64_t age_us, Time now,
                     Jobs* jobs);
  RenderJob& JobOf(const Subscription& subscription, const PictureSpec& spec, std::int64_t age_us,
                   Jobs* jobs);
  void SubmitJobs(Jobs* jobs);
  void FillImage(const FinishedPicture& picture);
  void SendPicture(Subscription& subscription, const FinishedPicture& picture,
                   const PictureTicket& ticket);
  void PictureFailed(Subscription& subscription);

  const Limits limits_;
  SubjectRegistry* const subjects_;
  PictureSource* const pictures_;
  ViewSettings settings_;
  const bool all_drivers_;
  Desk* const desk_;  // of whoever is alone in the hub
  Postman* const postman_;
  Metrics* const metrics_;
  std::unordered_map<std::uint64_t, std::unique_ptr<Subscription>> subscriptions_;  // by uid
  std::unordered_map<SubjectId, std::vector<Subscription*>> by_subject_;
  std::uint64_t next_uid_ = 1;
  protocol::ImageFrame image_;  // reused
  protocol::SkeletonOffer offer_;
  std::vector<std::uint8_t> encoded_offer_;
  bool has_named_large_picture_ = false;  // in the log
};

}  // namespace furrow::server
