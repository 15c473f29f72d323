// SPDX-License-Identifier: Apache-2.0
#include "protocol/codec/cluster_messages.h"

#include <cmath>
#include <cstddef>

#include "protocol/codec/pose_message.h"

namespace furrow::protocol::internal {
namespace {

using flatbuffers::Offset;
using flatbuffers::Vector;

// A pose that later poses build on: whole, of the skeleton of the state, without another one in it.
DecodeStatus ReadWholePose(const wire::Pose* table, std::uint64_t skeleton_hash, PoseFrame& pose) {
  FURROW_CHECK_DECODE(ReadTable(*table, pose));
  const bool fits = !pose.partial && pose.previous.empty() && pose.skeleton_hash == skeleton_hash;
  return fits ? DecodeStatus::kOk : DecodeStatus::kBadValue;
}

// `most`: the largest magnitude; `least`: the smallest number.
DecodeStatus ReadNumbers(const Vector<float>* numbers, std::size_t count, float least, float most,
                         std::vector<float>& out) {
  if (SizeOf(numbers) != count) return DecodeStatus::kBadCount;
  out.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = numbers->Get(static_cast<flatbuffers::uoffset_t>(i));
    if (!std::isfinite(out[i])) return DecodeStatus::kNonFinite;
    if (out[i] < least || out[i] > most) return DecodeStatus::kBadValue;
  }
  return DecodeStatus::kOk;
}

DecodeStatus ReadFilter(const wire::SubjectState& table, SubjectState& message) {
  const std::size_t count = SizeOf(table.filtered());
  if (count > static_cast<std::size_t>(kMaxWeights)) return DecodeStatus::kLimit;
  FURROW_CHECK_DECODE(ReadNumbers(table.filtered(), count, 0.0f, 1.0f, message.filtered));
  FURROW_CHECK_DECODE(ReadNumbers(table.inputs(), count, 0.0f, 1.0f, message.inputs));
  FURROW_CHECK_DECODE(
      ReadNumbers(table.speeds(), count, -kMaxMagnitude, kMaxMagnitude, message.speeds));
  message.values_hash = table.values_hash();
  message.num_drivers = table.num_drivers();
  message.since_input_s = table.since_input_s();
  if (!std::isfinite(message.since_input_s)) return DecodeStatus::kNonFinite;
  const bool in_range =
      message.since_input_s >= 0.0 && message.since_input_s <= double{kMaxMagnitude};
  return in_range ? DecodeStatus::kOk : DecodeStatus::kBadValue;
}

Offset<Vector<float>> WriteNumbers(PayloadBuilder& payload, const std::vector<float>& numbers) {
  return numbers.empty() ? 0 : payload.builder.CreateVector(numbers);
}

}  // namespace

DecodeStatus ReadTable(const wire::SubjectState& table, SubjectState& message) {
  FURROW_CHECK_DECODE(
      ReadText(table.subject(), kMaxNameBytes, message.subject, Presence::kRequired));
  message.skeleton_hash = table.skeleton_hash();
  message.publisher_session = table.publisher_session();
  message.run = table.run();
  message.has_pose = table.has_pose();
  message.newest_sequence = table.newest_sequence();
  message.pose = {};
  if (message.has_pose != (table.pose() != nullptr)) return DecodeStatus::kMissingField;
  if (message.has_pose) {
    FURROW_CHECK_DECODE(ReadWholePose(table.pose(), message.skeleton_hash, message.pose));
  }
  message.neutral = {};
  message.has_neutral = table.neutral() != nullptr;
  if (message.has_neutral) {
    FURROW_CHECK_DECODE(ReadWholePose(table.neutral(), message.skeleton_hash, message.neutral));
  }
  FURROW_CHECK_DECODE(ReadText(table.captures(), kMaxCaptureBytes, message.captures));
  return ReadFilter(table, message);
}

flatbuffers::Offset<wire::SubjectState> WriteTable(PayloadBuilder& payload,
                                                   const SubjectState& message) {
  const auto subject = WriteText(payload, message.subject);
  Offset<wire::Pose> pose = 0;
  if (message.has_pose) pose = WriteTable(payload, message.pose, PoseEncoding());
  Offset<wire::Pose> neutral = 0;
  if (message.has_neutral) neutral = WriteTable(payload, message.neutral, PoseEncoding());
  const auto filtered = WriteNumbers(payload, message.filtered);
  const auto inputs = WriteNumbers(payload, message.inputs);
  const auto speeds = WriteNumbers(payload, message.speeds);
  const auto captures = WriteText(payload, message.captures);
  return wire::CreateSubjectState(
      payload.builder, subject, message.skeleton_hash, message.publisher_session, message.run,
      message.has_pose, message.newest_sequence, pose, neutral, message.values_hash,
      message.num_drivers, filtered, inputs, speeds, message.since_input_s, captures);
}

DecodeStatus ReadTable(const wire::Drain& table, Drain& message) {
  message.begin = table.begin();
  return DecodeStatus::kOk;
}

flatbuffers::Offset<wire::Drain> WriteTable(PayloadBuilder& payload, const Drain& message) {
  return wire::CreateDrain(payload.builder, message.begin);
}

DecodeStatus ReadTable(const wire::DrainState& table, DrainState& message) {
  message.draining = table.draining();
  message.moved = table.moved();
  message.left = table.left();
  FURROW_CHECK_DECODE(ReadNames(table.names(), kMaxLeftNames, message.names));
  FURROW_CHECK_DECODE(ReadText(table.why(), kMaxTextBytes, message.why));
  return message.left < message.names.size() ? DecodeStatus::kBadCount : DecodeStatus::kOk;
}

flatbuffers::Offset<wire::DrainState> WriteTable(PayloadBuilder& payload,
                                                 const DrainState& message) {
  const auto names = WriteNames(payload, message.names);
  const auto why = WriteText(payload, message.why);
  return wire::CreateDrainState(payload.builder, message.draining, message.moved, message.left,
                                names, why);
}

}  // namespace furrow::protocol::internal
