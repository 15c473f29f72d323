// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "protocol/messages/messages.h"
#include "server/core/metrics.h"
#include "server/pipeline/render_mailbox.h"
#include "server/session/delivery/message_sender.h"

namespace furrow::server {

// The message sender and the buffers with which one thread publishes the frames of subjects. The
// buffers are reused, so that a pose allocates nothing.
struct PublishContext {
  PublishContext(std::uint64_t session, Metrics* metrics, int shard)
      : messages(session, metrics, shard) {}

  MessageSender messages;

  // Identifies the content of `encoded`. Subscriptions with equal keys share one encoding.
  struct EncodedWeightsKey {
    std::uint64_t names_hash = 0;
    protocol::WeightFormat format = protocol::WeightFormat::kF32;
    protocol::WeightSource source = protocol::WeightSource::kWrinkleWeights;
    friend bool operator==(const EncodedWeightsKey&, const EncodedWeightsKey&) = default;
  };
  std::optional<EncodedWeightsKey> encoded_key;  // reset before each subject and pose
  std::vector<std::uint8_t> encoded;             // a weight message with its envelope
  protocol::WeightFrame weights;
  protocol::PoseFrame pose;
  std::vector<RenderJob> jobs;  // of the subject being published, one per PictureSpec
};

}  // namespace furrow::server
