// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "server/session/delivery/publish_context.h"
#include "server/session/subscriptions/subscription.h"

namespace furrow::server {

// Sends the weights that `request`, the content of `subscription`, selects. `age_us`: time since
// the last pose; 0: from a new pose. If another subscription to this subject has just selected
// equal values, reuses their encoding in `context`. Stops allocating after a while.
void SendWeights(Subscription& subscription, const WeightsRequest& request, std::int64_t age_us,
                 PublishContext* context);

}  // namespace furrow::server
