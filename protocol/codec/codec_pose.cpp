// SPDX-License-Identifier: Apache-2.0
// Pose: STANDARD.md sections 5 and 7. The hot path: nothing here allocates once memory has grown.
#include <algorithm>
#include <cmath>

#include "protocol/codec/codec_internal.h"
#include "protocol/messages/quantise.h"
#include "protocol/schema/pose_generated.h"

namespace furrow::protocol {
namespace {

using flatbuffers::Offset;
using flatbuffers::uoffset_t;
using flatbuffers::Vector;
using internal::Builder;
using internal::SizeOf;

// At most one of a plain and a packed vector, and how many values it has.
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
    const wire::PackedQuat& quat = *packed.Get(static_cast<uoffset_t>(i));
    if (!UnpackQuat({quat.low(), quat.middle(), quat.high()}, rotations[i])) {
      return DecodeStatus::kBadValue;
    }
  }
  return DecodeStatus::kOk;
}

DecodeStatus ReadRotations(const wire::Pose& root, PoseFrame& pose) {
  std::size_t count = 0;
  FURROW_CHECK_DECODE(CountValues(root.rotations(), root.packed_rotations(), count));
  FURROW_CHECK_DECODE(
      internal::ReadMask(root.rotation_mask(), pose.num_joints, count, pose.rotation_joints));
  pose.rotations.resize(count);
  if (root.packed_rotations() != nullptr) {
    return ReadPackedRotations(*root.packed_rotations(), pose.rotations);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const wire::Quat& q = *root.rotations()->Get(static_cast<uoffset_t>(i));
    pose.rotations[i] = {q.x(), q.y(), q.z(), q.w()};
    FURROW_CHECK_DECODE(internal::CheckRotation(pose.rotations[i]));
  }
  return DecodeStatus::kOk;
}

bool IsOffset(std::int16_t packed) { return packed >= -32767; }

DecodeStatus ReadTranslations(const wire::Pose& root, PoseFrame& pose) {
  std::size_t count = 0;
  FURROW_CHECK_DECODE(CountValues(root.translations(), root.packed_translations(), count));
  FURROW_CHECK_DECODE(
      internal::ReadMask(root.translation_mask(), pose.num_joints, count, pose.translation_joints));
  const float range = root.translation_range();
  FURROW_CHECK_DECODE(internal::CheckNumber(range));
  if (range < 0.0f) return DecodeStatus::kBadValue;
  pose.translations.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = static_cast<uoffset_t>(i);
    Vec3& out = pose.translations[i];
    if (root.packed_translations() != nullptr) {
      const wire::PackedOffset& p = *root.packed_translations()->Get(at);
      if (!IsOffset(p.x()) || !IsOffset(p.y()) || !IsOffset(p.z())) return DecodeStatus::kBadValue;
      out = {UnpackOffset(p.x(), range), UnpackOffset(p.y(), range), UnpackOffset(p.z(), range)};
    } else {
      const wire::Vec3& v = *root.translations()->Get(at);
      out = {v.x(), v.y(), v.z()};
      FURROW_CHECK_DECODE(internal::CheckVector(out));
    }
  }
  return DecodeStatus::kOk;
}

DecodeStatus ReadScales(const wire::Pose& root, PoseFrame& pose) {
  const std::size_t count = SizeOf(root.scales());
  FURROW_CHECK_DECODE(
      internal::ReadMask(root.scale_mask(), pose.num_joints, count, pose.scale_joints));
  pose.scales.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const wire::Vec3& v = *root.scales()->Get(static_cast<uoffset_t>(i));
    pose.scales[i] = {v.x(), v.y(), v.z()};
    FURROW_CHECK_DECODE(internal::CheckVector(pose.scales[i]));
  }
  return DecodeStatus::kOk;
}

DecodeStatus ReadBlendShapes(const wire::Pose& root, PoseFrame& pose) {
  std::size_t count = 0;
  FURROW_CHECK_DECODE(CountValues(root.blend_shapes(), root.packed_blend_shapes(), count));
  FURROW_CHECK_DECODE(internal::ReadMask(root.blend_shape_mask(), pose.num_blend_shapes, count,
                                         pose.blend_shape_indices));
  pose.blend_shapes.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = static_cast<uoffset_t>(i);
    if (root.packed_blend_shapes() != nullptr) {
      const std::int16_t packed = root.packed_blend_shapes()->Get(at);
      if (!IsOffset(packed)) return DecodeStatus::kBadValue;
      pose.blend_shapes[i] = UnpackBlendShape(packed);
    } else {
      pose.blend_shapes[i] = root.blend_shapes()->Get(at);
      FURROW_CHECK_DECODE(internal::CheckNumber(pose.blend_shapes[i]));
    }
  }
  return DecodeStatus::kOk;
}

float LargestOffset(std::span<const Vec3> offsets) {
  float largest = 0.0f;
  for (const Vec3& v : offsets) {
    largest = std::max({largest, std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
  }
  return largest;
}

template <class Wire, class Value, class Convert>
Offset<Vector<const Wire*>> WriteStructs(Builder& builder, const std::vector<Value>& values,
                                         const Convert& convert) {
  if (values.empty()) return 0;
  // Not CreateUninitializedVectorOfStructs(): in
  // FlatBuffers 2.0.8 it aligns to the size of the struct.
  return builder.CreateVectorOfStructs<Wire>(
      values.size(),
      [&convert](std::size_t i, Wire* out, const std::vector<Value>* from) {
        *out = convert((*from)[i]);
      },
      &values);
}

wire::Vec3 ToWire(const Vec3& v) { return {v.x, v.y, v.z}; }

Offset<Vector<const wire::PackedQuat*>> WritePackedRotations(Builder& builder,
                                                             const std::vector<Quat>& rotations) {
  return WriteStructs<wire::PackedQuat>(builder, rotations, [](const Quat& q) {
    const PackedQuat packed = PackQuat(q);
    return wire::PackedQuat(packed[0], packed[1], packed[2]);
  });
}

Offset<Vector<std::int16_t>> WritePackedShapes(Builder& builder, const std::vector<float>& values) {
  if (values.empty()) return 0;
  std::int16_t* out = nullptr;
  const auto offset = builder.CreateUninitializedVector<std::int16_t>(values.size(), &out);
  for (std::size_t i = 0; i < values.size(); ++i) out[i] = PackBlendShape(values[i]);
  return Offset<Vector<std::int16_t>>(offset);
}

}  // namespace

DecodeStatus Decode(const MessageView& view, PoseFrame& message) {
  const wire::Pose* root = nullptr;
  FURROW_CHECK_DECODE(internal::Verify(view, MessageKind::kPose, root));
  message.skeleton_hash = root->skeleton_hash();
  message.partial = root->partial();
  message.num_joints = root->num_joints();
  message.num_blend_shapes = root->num_blend_shapes();
  if (message.num_joints > kMaxJoints || message.num_blend_shapes > kMaxBlendShapes) {
    return DecodeStatus::kLimit;
  }
  FURROW_CHECK_DECODE(ReadRotations(*root, message));
  FURROW_CHECK_DECODE(ReadTranslations(*root, message));
  FURROW_CHECK_DECODE(ReadScales(*root, message));
  return ReadBlendShapes(*root, message);
}

void Encoder::Encode(const Header& header, const PoseFrame& message, std::vector<std::uint8_t>& out,
                     const PoseEncoding& encoding) {
  Builder& builder = state_->builder;
  builder.Clear();
  const std::size_t joints = message.num_joints;
  Offset<Vector<const wire::Quat*>> rotations = 0;
  Offset<Vector<const wire::PackedQuat*>> packed_rotations = 0;
  if (encoding.quantise_rotations) {
    packed_rotations = WritePackedRotations(builder, message.rotations);
  } else {
    rotations = WriteStructs<wire::Quat>(
        builder, message.rotations, [](const Quat& q) { return wire::Quat(q.x, q.y, q.z, q.w); });
  }
  Offset<Vector<const wire::Vec3*>> translations = 0;
  Offset<Vector<const wire::PackedOffset*>> packed_translations = 0;
  float range = 0.0f;
  if (encoding.quantise_translations) {
    range = LargestOffset(message.translations);
    packed_translations =
        WriteStructs<wire::PackedOffset>(builder, message.translations, [range](const Vec3& v) {
          return wire::PackedOffset(PackOffset(v.x, range), PackOffset(v.y, range),
                                    PackOffset(v.z, range));
        });
  } else {
    translations = WriteStructs<wire::Vec3>(builder, message.translations, ToWire);
  }
  const auto scales = WriteStructs<wire::Vec3>(builder, message.scales, ToWire);
  Offset<Vector<float>> shapes = 0;
  Offset<Vector<std::int16_t>> packed_shapes = 0;
  if (encoding.quantise_blend_shapes) {
    packed_shapes = WritePackedShapes(builder, message.blend_shapes);
  } else if (!message.blend_shapes.empty()) {
    shapes = builder.CreateVector(message.blend_shapes);
  }
  const auto rotation_mask = internal::WriteMask(*state_, message.rotation_joints, joints);
  const auto translation_mask = internal::WriteMask(*state_, message.translation_joints, joints);
  const auto scale_mask = internal::WriteMask(*state_, message.scale_joints, joints);
  const auto shape_mask =
      internal::WriteMask(*state_, message.blend_shape_indices, message.num_blend_shapes);
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
  internal::Finish(builder, pose.Finish(), header, MessageKind::kPose, out);
}

}  // namespace furrow::protocol
