// SPDX-License-Identifier: Apache-2.0
#include "server/session/subscriptions/weight_sender.h"

#include <algorithm>
#include <cstddef>
#include <span>

namespace furrow::server {
namespace {

// Weight frames that may wait for a slow peer, unless it asked for every one.
constexpr std::size_t kMaxQueuedWeights = 4;

// Fills `context->encoded`, unless it already holds these values. The envelope in it is not used:
// each peer's frame gets its own around the shared payload.
void EncodeWeights(const Subject& subject, const WeightsRequest& request, std::int64_t age_us,
                   PublishContext* context) {
  const PublishContext::EncodedWeightsKey key{request.names_hash, request.format, request.source};
  // Equal name hashes mean equal lists of indices, because all come from one binding.
  if (context->encoded_key == key) return;
  context->encoded_key = key;
  const SubjectPipeline& pipeline = *subject.pipeline;
  const std::span<const float> values = request.source == protocol::WeightSource::kDriverValues
                                            ? pipeline.driver_values()
                                            : pipeline.wrinkle_weights();
  protocol::WeightFrame& weights = context->weights;
  weights.names_hash = request.names_hash;
  weights.age_us = age_us;
  weights.timecode = subject.timecode;
  weights.format = request.format;
  weights.values.resize(request.indices.size());
  std::ranges::transform(request.indices, weights.values.begin(),
                         [values](std::uint32_t index) { return values[index]; });
  context->messages.Encode(weights, context->encoded);
}

}  // namespace

void SendWeights(Subscription& subscription, const WeightsRequest& request, std::int64_t age_us,
                 PublishContext* context) {
  const SubjectPipeline& pipeline = *subscription.subject->pipeline;
  EncodeWeights(*subscription.subject, request, age_us, context);
  subscription.dropped +=
      context->messages
          .SendEncodedFrame(*subscription.peer, subscription.uid,
                            {.stream = subscription.id,
                             .sequence = pipeline.sequence(),
                             .capture_time_us = pipeline.capture_time_us()},
                            std::span(context->encoded).subspan(protocol::kEnvelopeBytes),
                            Counter::kWeightsSent, Counter::kWeightsDroppedSlow,
                            subscription.every ? kKeepAll : kMaxQueuedWeights)
          .dropped;
}

}  // namespace furrow::server
