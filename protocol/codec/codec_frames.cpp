// SPDX-License-Identifier: Apache-2.0
// Weights: STANDARD.md section 9.
#include <algorithm>
#include <cmath>

#include "protocol/codec/codec_internal.h"
#include "protocol/messages/quantise.h"
#include "protocol/schema/weights_generated.h"

namespace furrow::protocol {
namespace {

using flatbuffers::Offset;
using flatbuffers::uoffset_t;
using flatbuffers::Vector;
using internal::Builder;
using internal::Finish;
using internal::SizeOf;
using internal::Verify;

DecodeStatus ReadValues(const wire::Weights& root, std::vector<float>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto at = static_cast<uoffset_t>(i);
    if (root.packed_values() != nullptr) {
      values[i] = UnpackWeight(root.packed_values()->Get(at));
      continue;
    }
    values[i] = root.values()->Get(at);
    if (!std::isfinite(values[i])) return DecodeStatus::kNonFinite;
    if (values[i] < 0.0f || values[i] > 1.0f) return DecodeStatus::kBadValue;
  }
  return DecodeStatus::kOk;
}

}  // namespace

DecodeStatus Decode(const MessageView& view, WeightFrame& message) {
  const wire::Weights* root = nullptr;
  FURROW_CHECK_DECODE(Verify(view, MessageKind::kWeights, root));
  if (root->values() != nullptr && root->packed_values() != nullptr) {
    return DecodeStatus::kBadCount;
  }
  const std::size_t count = SizeOf(root->values()) + SizeOf(root->packed_values());
  if (count > kMaxWeights) return DecodeStatus::kLimit;
  if (root->age_us() < 0) return DecodeStatus::kBadValue;
  message.names_hash = root->names_hash();
  message.age_us = root->age_us();
  message.format = root->packed_values() != nullptr ? WeightFormat::kU8 : WeightFormat::kF32;
  message.values.resize(count);
  return ReadValues(*root, message.values);
}

void Encoder::Encode(const Header& header, const WeightFrame& message,
                     std::vector<std::uint8_t>& out) {
  Builder& builder = state_->builder;
  builder.Clear();
  const std::size_t count = message.values.size();
  Offset<Vector<float>> values = 0;
  Offset<Vector<std::uint8_t>> packed = 0;
  if (message.format == WeightFormat::kU8) {
    std::uint8_t* bytes = nullptr;
    packed = builder.CreateUninitializedVector<std::uint8_t>(count, &bytes);
    std::transform(message.values.begin(), message.values.end(), bytes, PackWeight);
  } else {
    values = builder.CreateVector(message.values);
  }
  Finish(builder, wire::CreateWeights(builder, message.names_hash, message.age_us, values, packed),
         header, MessageKind::kWeights, out);
}

}  // namespace furrow::protocol
