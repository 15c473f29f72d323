// SPDX-License-Identifier: Apache-2.0
#include "protocol/codec/weights_message.h"

#include <algorithm>
#include <cmath>

#include "protocol/messages/quantise.h"

namespace furrow::protocol::internal {
namespace {

// Packed weights are in [0, 1] by construction; floats are checked.
DecodeStatus ReadValues(const wire::Weights& table, std::vector<float>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto at = static_cast<flatbuffers::uoffset_t>(i);
    if (table.packed_values() != nullptr) {
      values[i] = UnpackWeight(table.packed_values()->Get(at));
      continue;
    }
    values[i] = table.values()->Get(at);
    if (!std::isfinite(values[i])) return DecodeStatus::kNonFinite;
    if (values[i] < 0.0f || values[i] > 1.0f) return DecodeStatus::kBadValue;
  }
  return DecodeStatus::kOk;
}

}  // namespace

DecodeStatus ReadTable(const wire::Weights& table, WeightFrame& message) {
  if (table.values() != nullptr && table.packed_values() != nullptr) {
    return DecodeStatus::kBadCount;
  }
  const std::size_t count = SizeOf(table.values()) + SizeOf(table.packed_values());
  if (count > kMaxWeights) return DecodeStatus::kLimit;
  if (table.age_us() < 0) return DecodeStatus::kBadValue;
  message.names_hash = table.names_hash();
  message.age_us = table.age_us();
  message.format = table.packed_values() != nullptr ? WeightFormat::kU8 : WeightFormat::kF32;
  message.timecode = ReadTimecode(table.timecode());
  message.values.resize(count);
  return ReadValues(table, message.values);
}

flatbuffers::Offset<wire::Weights> WriteTable(PayloadBuilder& payload, const WeightFrame& message) {
  const std::size_t count = message.values.size();
  flatbuffers::Offset<flatbuffers::Vector<float>> values = 0;
  flatbuffers::Offset<flatbuffers::Vector<std::uint8_t>> packed = 0;
  // The vector is present even if it is empty, because its presence states the format.
  if (message.format == WeightFormat::kU8) {
    std::uint8_t* bytes = nullptr;
    packed = payload.builder.CreateUninitializedVector<std::uint8_t>(count, &bytes);
    std::transform(message.values.begin(), message.values.end(), bytes, PackWeight);
  } else {
    values = payload.builder.CreateVector(message.values);
  }
  const wire::Timecode timecode = ToWire(message.timecode.value_or(Timecode()));
  return wire::CreateWeights(payload.builder, message.names_hash, message.age_us, values, packed,
                             message.timecode ? &timecode : nullptr);
}

}  // namespace furrow::protocol::internal
