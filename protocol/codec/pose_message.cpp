// SPDX-License-Identifier: Apache-2.0
#include "protocol/codec/pose_message.h"

#include <algorithm>
#include <cmath>

namespace furrow::protocol::internal {
namespace {

using flatbuffers::Offset;
using flatbuffers::Vector;

// Sets `count` to the number of values. At most one of the two forms may be present.
template <class Plain, class Packed>
DecodeStatus CountValues(const Vector<Plain>* plain, const Vector<Packed>* packed,
                         std::size_t& count) {
  if (plain != nullptr && packed != nullptr) return DecodeStatus::kBadCount;
  count = SizeOf(plain) + SizeOf(packed);
  return DecodeStatus::kOk;
}

DecodeStatus ReadPackedRotations(const Vector<const wire::PackedQuat*>& packed,
                                 std::span<Quat> rotations) {
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    const wire::PackedQuat& quat = *packed.Get(static_cast<flatbuffers::uoffset_t>(i));
    if (!UnpackQuat({quat.low(), quat.middle(), quat.high()}, rotations[i])) {
      return DecodeStatus::kBadValue;
    }
  }
  return DecodeStatus::kOk;
}

DecodeStatus ReadRotations(const wire::Pose& table, PoseFrame& pose) {
  std::size_t count = 0;
  FURROW_CHECK_DECODE(CountValues(table.rotations(), table.packed_rotations(), count));
  // The mask states which joints have values. Without a mask, all have one or none has.
  FURROW_CHECK_DECODE(
      ReadMask(table.rotation_mask(), pose.num_joints, count, pose.rotation_joints));
  pose.rotations.resize(count);
  if (table.packed_rotations() != nullptr) {
    return ReadPackedRotations(*table.packed_rotations(), pose.rotations);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const wire::Quat& q = *table.rotations()->Get(static_cast<flatbuffers::uoffset_t>(i));
    pose.rotations[i] = FromWire(q);
    FURROW_CHECK_DECODE(CheckRotation(pose.rotations[i]));
  }
  return DecodeStatus::kOk;
}

// -32768 is malformed: the range of packed numbers is symmetric.
bool IsPackedNumber(std::int16_t packed) { return packed >= -32767; }

DecodeStatus ReadTranslations(const wire::Pose& table, PoseFrame& pose) {
  std::size_t count = 0;
  FURROW_CHECK_DECODE(CountValues(table.translations(), table.packed_translations(), count));
  FURROW_CHECK_DECODE(
      ReadMask(table.translation_mask(), pose.num_joints, count, pose.translation_joints));
  const float range = table.translation_range();
  // The range scales the packed numbers, so they are finite if the range is.
  FURROW_CHECK_DECODE(CheckNumber(range));
  if (range < 0.0f) return DecodeStatus::kBadValue;
  pose.translations.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = static_cast<flatbuffers::uoffset_t>(i);
    Vec3& out = pose.translations[i];
    if (table.packed_translations() != nullptr) {
      const wire::PackedOffset& p = *table.packed_translations()->Get(at);
      if (!IsPackedNumber(p.x()) || !IsPackedNumber(p.y()) || !IsPackedNumber(p.z()))
        return DecodeStatus::kBadValue;
      out = {UnpackOffset(p.x(), range), UnpackOffset(p.y(), range), UnpackOffset(p.z(), range)};
    } else {
      out = FromWire(*table.translations()->Get(at));
      FURROW_CHECK_DECODE(CheckVector(out));
    }
  }
  return DecodeStatus::kOk;
}

DecodeStatus ReadScales(const wire::Pose& table, PoseFrame& pose) {
  const std::size_t count = SizeOf(table.scales());
  FURROW_CHECK_DECODE(ReadMask(table.scale_mask(), pose.num_joints, count, pose.scale_joints));
  pose.scales.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    pose.scales[i] = FromWire(*table.scales()->Get(static_cast<flatbuffers::uoffset_t>(i)));
    FURROW_CHECK_DECODE(CheckVector(pose.scales[i]));
  }
  return DecodeStatus::kOk;
}

DecodeStatus ReadBlendShapes(const wire::Pose& table, PoseFrame& pose) {
  std::size_t count = 0;
  FURROW_CHECK_DECODE(CountValues(table.blend_shapes(), table.packed_blend_shapes(), count));
  FURROW_CHECK_DECODE(
      ReadMask(table.blend_shape_mask(), pose.num_blend_shapes, count, pose.blend_shape_indices));
  pose.blend_shapes.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = static_cast<flatbuffers::uoffset_t>(i);
    if (table.packed_blend_shapes() != nullptr) {
      const std::int16_t packed = table.packed_blend_shapes()->Get(at);
      if (!IsPackedNumber(packed)) return DecodeStatus::kBadValue;
      pose.blend_shapes[i] = UnpackBlendShape(packed);
    } else {
      pose.blend_shapes[i] = table.blend_shapes()->Get(at);
      FURROW_CHECK_DECODE(CheckNumber(pose.blend_shapes[i]));
    }
  }
  return DecodeStatus::kOk;
}

// Copies the previous pose without reading it: few receivers need it.
DecodeStatus ReadPrevious(const wire::Pose& table, PoseFrame& pose) {
  pose.previous_age_us = table.previous_age_us();
  pose.previous.clear();
  if (table.previous() == nullptr) return DecodeStatus::kOk;
  if (table.previous()->size() > kMaxDatagramBytes) return DecodeStatus::kLimit;
  pose.previous.assign(table.previous()->begin(), table.previous()->end());
  return DecodeStatus::kOk;
}

// The range for packed translations: the largest magnitude of any component.
float LargestOffset(std::span<const Vec3> offsets) {
  float largest = 0.0f;
  for (const Vec3& v : offsets) {
    largest = std::max({largest, std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
  }
  return largest;
}

template <class Wire, class Value, class Convert>
Offset<Vector<const Wire*>> WriteStructs(flatbuffers::FlatBufferBuilder& builder,
                                         const std::vector<Value>& values, const Convert& convert) {
  if (values.empty()) return 0;
  // CreateUninitializedVectorOfStructs() does not serve here: in FlatBuffers 2.0.8 it aligns to the
  // size of the struct.
  return builder.CreateVectorOfStructs<Wire>(
      values.size(),
      [&convert](std::size_t i, Wire* out, const std::vector<Value>* from) {
        *out = convert((*from)[i]);
      },
      &values);
}

Offset<Vector<const wire::PackedQuat*>> WritePackedRotations(
    flatbuffers::FlatBufferBuilder& builder, const std::vector<Quat>& rotations) {
  return WriteStructs<wire::PackedQuat>(builder, rotations, [](const Quat& q) {
    const PackedQuat packed = PackQuat(q);
    return wire::PackedQuat(packed[0], packed[1], packed[2]);
  });
}

// `range`: the largest offset.
Offset<Vector<const wire::PackedOffset*>> WritePackedTranslations(
    flatbuffers::FlatBufferBuilder& builder, const std::vector<Vec3>& translations, float range) {
  return WriteStructs<wire::PackedOffset>(builder, translations, [range](const Vec3& v) {
    return wire::PackedOffset(PackOffset(v.x, range), PackOffset(v.y, range),
                              PackOffset(v.z, range));
  });
}

Offset<Vector<std::int16_t>> WritePackedShapes(flatbuffers::FlatBufferBuilder& builder,
                                               const std::vector<float>& values) {
  if (values.empty()) return 0;
  std::int16_t* out = nullptr;
  const auto offset = builder.CreateUninitializedVector<std::int16_t>(values.size(), &out);
  for (std::size_t i = 0; i < values.size(); ++i) out[i] = PackBlendShape(values[i]);
  return Offset<Vector<std::int16_t>>(offset);
}

}  // namespace

DecodeStatus ReadTable(const wire::Pose& table, PoseFrame& message) {
  message.skeleton_hash = table.skeleton_hash();
  message.partial = table.partial();
  message.num_joints = table.num_joints();
  message.num_blend_shapes = table.num_blend_shapes();
  // The counts come from the sender and size the masks, so they are checked first.
  if (message.num_joints > kMaxJoints || message.num_blend_shapes > kMaxBlendShapes) {
    return DecodeStatus::kLimit;
  }
  FURROW_CHECK_DECODE(ReadRotations(table, message));
  FURROW_CHECK_DECODE(ReadTranslations(table, message));
  FURROW_CHECK_DECODE(ReadScales(table, message));
  FURROW_CHECK_DECODE(ReadPrevious(table, message));
  message.timecode = ReadTimecode(table.timecode());
  return ReadBlendShapes(table, message);
}

flatbuffers::Offset<wire::Pose> WriteTable(PayloadBuilder& payload, const PoseFrame& message,
                                           const PoseEncoding& encoding) {
  flatbuffers::FlatBufferBuilder& builder = payload.builder;
  const std::size_t joints = message.num_joints;
  const auto to_wire = [](const auto& value) { return ToWire(value); };
  Offset<Vector<const wire::Quat*>> rotations = 0;
  Offset<Vector<const wire::PackedQuat*>> packed_rotations = 0;
  if (encoding.quantise_rotations) {
    packed_rotations = WritePackedRotations(builder, message.rotations);
  } else {
    rotations = WriteStructs<wire::Quat>(builder, message.rotations, to_wire);
  }
  Offset<Vector<const wire::Vec3*>> translations = 0;
  Offset<Vector<const wire::PackedOffset*>> packed_translations = 0;
  float range = 0.0f;
  if (encoding.quantise_translations) {
    range = LargestOffset(message.translations);
    packed_translations = WritePackedTranslations(builder, message.translations, range);
  } else {
    translations = WriteStructs<wire::Vec3>(builder, message.translations, to_wire);
  }
  const auto scales = WriteStructs<wire::Vec3>(builder, message.scales, to_wire);
  Offset<Vector<float>> shapes = 0;
  Offset<Vector<std::int16_t>> packed_shapes = 0;
  if (encoding.quantise_blend_shapes) {
    packed_shapes = WritePackedShapes(builder, message.blend_shapes);
  } else if (!message.blend_shapes.empty()) {
    shapes = builder.CreateVector(message.blend_shapes);
  }
  // All vectors must be finished before the table begins: FlatBuffers cannot nest.
  const auto rotation_mask = WriteMask(payload, message.rotation_joints, joints);
  const auto translation_mask = WriteMask(payload, message.translation_joints, joints);
  const auto scale_mask = WriteMask(payload, message.scale_joints, joints);
  const auto shape_mask = WriteMask(payload, message.blend_shape_indices, message.num_blend_shapes);
  Offset<Vector<std::uint8_t>> previous = 0;
  if (!message.previous.empty()) previous = builder.CreateVector(message.previous);
  const wire::Timecode timecode = ToWire(message.timecode.value_or(Timecode()));
  wire::PoseBuilder pose(builder);
  pose.add_skeleton_hash(message.skeleton_hash);
  pose.add_num_joints(message.num_joints);
  pose.add_num_blend_shapes(message.num_blend_shapes);
  pose.add_partial(message.partial);
  pose.add_rotation_mask(rotation_mask);
  pose.add_rotations(rotations);
  pose.add_packed_rotations(packed_rotations);
  pose.add_translation_mask(translation_mask);
  pose.add_translations(translations);
  pose.add_packed_translations(packed_translations);
  pose.add_translation_range(range);
  pose.add_scale_mask(scale_mask);
  pose.add_scales(scales);
  pose.add_blend_shape_mask(shape_mask);
  pose.add_blend_shapes(shapes);
  pose.add_packed_blend_shapes(packed_shapes);
  pose.add_previous(previous);
  pose.add_previous_age_us(message.previous.empty() ? 0 : message.previous_age_us);
  if (message.timecode) pose.add_timecode(&timecode);
  return pose.Finish();
}

}  // namespace furrow::protocol::internal
