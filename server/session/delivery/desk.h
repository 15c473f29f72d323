// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "protocol/messages/messages.h"
#include "server/core/metrics.h"
#include "server/pipeline/render_mailbox.h"
#include "server/session/delivery/postman.h"

namespace furrow::server {

// What one thread makes and sends frames with: a postman, and what is filled again and again, so
// that a pose does not allocate.
struct Desk {
  using Jobs = std::vector<RenderJob>;  // one a spec

  Desk(std::uint64_t session, Metrics* metrics, int lane) : postman(session, metrics, lane) {}

  Postman postman;
  // What `encoded` holds of the subject that is being published.
  struct EncodedWish {
    std::uint64_t names_hash = 0;
    protocol::WeightFormat format = protocol::WeightFormat::kF32;
    protocol::WeightSource source = protocol::WeightSource::kWrinkleWeights;
    friend bool operator==(const EncodedWish&, const EncodedWish&) = default;
  };
  std::optional<EncodedWish> encoded_wish;
  std::vector<std::uint8_t> encoded;
  protocol::WeightFrame weights;
  protocol::PoseFrame pose;
  Jobs jobs;
};

}  // namespace furrow::server
