// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "protocol/messages/messages.h"
#include "server/core/time.h"
#include "server/session/delivery/message_sender.h"
#include "server/session/delivery/publish_context.h"
#include "server/session/peers/peer.h"
#include "server/session/subjects/subject_registry.h"
#include "server/session/subscriptions/subscription.h"

namespace furrow::server {

// Forwards skeletons and poses to the subscribers of poses, such as `furrow record` and a second
// daemon (STANDARD.md section 8).
class PoseRelay {
 public:
  // `messages`: for everything but poses; used only while the hub is locked exclusively.
  explicit PoseRelay(MessageSender* messages) : messages_(messages) {}

  // False: the skeleton of the subject is too large for UDP, the peer's transport.
  [[nodiscard]] bool Fits(const Subject& subject, Transport transport);
  // Sends the skeleton of the bound subject to the subscriber.
  void SendSkeleton(const Subscription& subscription);
  // True if the subscriber has received the current publisher and skeleton of the subject.
  [[nodiscard]] static bool IsCurrent(const PoseRequest& request, const Subject& subject) {
    return request.publisher == subject.run && request.skeleton_hash == subject.skeleton_hash;
  }

  // Sends the subject's pose: `payload` as it was received, or, if it is empty, the whole pose
  // encoded again. Does not allocate in the long run.
  static void SendPose(Subscription& subscription, std::span<const std::uint8_t> payload,
                       PublishContext* context);
  // Tells a subscriber that asked for every frame how many it lost, at most once per second.
  void ReportDropped(Subscription& subscription, Time now);

 private:
  void FillOffer(const Subject& subject);

  MessageSender* const messages_;
  protocol::SkeletonOffer offer_;
  std::vector<std::uint8_t> encoded_offer_;
};

}  // namespace furrow::server
