// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "server/session/delivery/publish_context.h"
#include "server/session/subscriptions/subscription.h"

namespace furrow::server {

// Sends the weights that the subscription selects, with their age (0: from a new pose). Reuses the
// encoding in `context` if another subscription of the same subject asked for the same values. Does
// not allocate in the long run.
void SendWeights(Subscription& subscription, const WeightsRequest& request, std::int64_t age_us,
                 PublishContext* context);

}  // namespace furrow::server
