// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "server/core/metrics.h"
#include "server/core/time.h"
#include "server/session/delivery/publish_context.h"
#include "server/session/subjects/subject_registry.h"
#include "server/session/subscriptions/picture_views.h"
#include "server/session/subscriptions/pose_relay.h"
#include "server/session/subscriptions/subscription.h"
#include "server/session/subscriptions/subscription_table.h"

namespace furrow::server {

// Hands each pose of a subject to its subscriptions: decides which of them are due, and sends
// weights, relays the pose or requests a picture.
class FanOut {
 public:
  // `exclusive_context`: used by SendOwed(). All arguments outlive this object.
  FanOut(const SubscriptionTable* table, PoseRelay* poses, PictureViews* pictures,
         PublishContext* exclusive_context, Metrics* metrics)
      : table_(table),
        poses_(poses),
        pictures_(pictures),
        exclusive_context_(exclusive_context),
        metrics_(metrics) {}

  // Delivers the subject's newest weights and pose to every subscription that is due. `pose`: the
  // payload that the pose came as; empty for a partial pose or if no pose came. `age_us`: 0 for a
  // new pose, else the time since the last one.
  //
  // Several threads may publish different subjects at once, each with its own context. Does not
  // allocate in the long run, unless a picture is requested.
  void Publish(Subject& subject, std::span<const std::uint8_t> pose, std::int64_t age_us, Time now,
               PublishContext* context);

  // Sends the poses that a rate limit or a stuck peer held back, so that the last pose of a
  // movement always arrives. Requires exclusive access to the hub.
  void SendOwed(Time now);
  // Sends the pose that was held back from one subscription, if its rate and its flow control allow
  // it now. Precondition: the subscription is bound to a subject. Requires exclusive access to the
  // hub.
  void SendOwed(Subscription& subscription, Time now);

 private:
  [[nodiscard]] bool HoldBack(Subscription& subscription);
  void Deliver(Subscription& subscription, std::span<const std::uint8_t> pose, std::int64_t age_us,
               Time now, PublishContext* context);

  const SubscriptionTable* const table_;
  PoseRelay* const poses_;
  PictureViews* const pictures_;
  PublishContext* const exclusive_context_;
  Metrics* const metrics_;
};

}  // namespace furrow::server
