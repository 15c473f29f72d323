// SPDX-License-Identifier: Apache-2.0
#include "protocol/codec/skeleton_messages.h"

#include <utility>

#include "protocol/messages/hash.h"

namespace furrow::protocol::internal {
namespace {

using flatbuffers::uoffset_t;

// Parallel vectors must agree in size before any is indexed.
DecodeStatus CheckCounts(const wire::SkeletonOffer& table) {
  const std::size_t joints = SizeOf(table.names());
  if (joints > kMaxJoints) return DecodeStatus::kLimit;
  if (joints + SizeOf(table.blend_shape_names()) == 0) return DecodeStatus::kMissingField;
  const bool equal = SizeOf(table.parents()) == joints &&
                     SizeOf(table.rest_translations()) == joints &&
                     SizeOf(table.rest_rotations()) == joints &&
                     (table.rest_scales() == nullptr || table.rest_scales()->size() == joints);
  return equal ? DecodeStatus::kOk : DecodeStatus::kBadCount;
}

DecodeStatus ReadJoint(const wire::SkeletonOffer& table, uoffset_t i, OfferedJoint& joint) {
  joint.name.assign(table.names()->Get(i)->c_str(), table.names()->Get(i)->size());
  joint.parent = table.parents()->Get(i);
  // Parents come first on the wire, which also rules out cycles.
  if (joint.parent < -1 || joint.parent >= static_cast<int>(i)) return DecodeStatus::kBadValue;
  joint.rest_translation = FromWire(*table.rest_translations()->Get(i));
  joint.rest_rotation = FromWire(*table.rest_rotations()->Get(i));
  joint.rest_scale =
      table.rest_scales() == nullptr ? Vec3{1, 1, 1} : FromWire(*table.rest_scales()->Get(i));
  joint.has_tail = false;
  joint.tail = {};
  FURROW_CHECK_DECODE(CheckVector(joint.rest_translation));
  FURROW_CHECK_DECODE(CheckVector(joint.rest_scale));
  return CheckRotation(joint.rest_rotation);
}

DecodeStatus ReadTails(const wire::SkeletonOffer& table, std::vector<OfferedJoint>& joints) {
  std::vector<std::uint16_t> indices;
  const std::size_t num_tails = SizeOf(table.tails());
  FURROW_CHECK_DECODE(ReadMask(table.tail_mask(), joints.size(), num_tails, indices));
  for (std::size_t i = 0; i < num_tails; ++i) {
    OfferedJoint& joint = joints[indices[i]];
    joint.has_tail = true;
    joint.tail = FromWire(*table.tails()->Get(static_cast<uoffset_t>(i)));
    FURROW_CHECK_DECODE(CheckVector(joint.tail));
  }
  return DecodeStatus::kOk;
}

// A column per field: parallel vectors take fewer bytes than one table per joint.
struct JointColumns {
  std::vector<flatbuffers::Offset<flatbuffers::String>> names;
  std::vector<std::int16_t> parents;
  std::vector<wire::Vec3> translations;
  std::vector<wire::Quat> rotations;
  std::vector<wire::Vec3> scales;
  bool has_scales = false;
  std::vector<std::uint16_t> tail_joints;
  std::vector<wire::Vec3> tails;
};

JointColumns MakeColumns(flatbuffers::FlatBufferBuilder& builder,
                         const std::vector<OfferedJoint>& joints) {
  JointColumns columns;
  for (const OfferedJoint& joint : joints) {
    columns.names.push_back(builder.CreateString(joint.name));
    columns.parents.push_back(joint.parent);
    columns.translations.push_back(ToWire(joint.rest_translation));
    columns.rotations.push_back(ToWire(joint.rest_rotation));
    columns.scales.push_back(ToWire(joint.rest_scale));
    columns.has_scales |= joint.rest_scale != Vec3{1, 1, 1};
    if (joint.has_tail) {
      columns.tail_joints.push_back(static_cast<std::uint16_t>(columns.names.size() - 1));
      columns.tails.push_back(ToWire(joint.tail));
    }
  }
  return columns;
}

}  // namespace

DecodeStatus ReadTable(const wire::SkeletonOffer& table, SkeletonOffer& message) {
  FURROW_CHECK_DECODE(CheckCounts(table));
  FURROW_CHECK_DECODE(
      ReadText(table.subject(), kMaxNameBytes, message.subject, Presence::kRequired));
  FURROW_CHECK_DECODE(CheckNames(table.names(), kMaxJoints));
  message.metres_per_unit = table.metres_per_unit();
  FURROW_CHECK_DECODE(CheckNumber(message.metres_per_unit));
  if (message.metres_per_unit <= 0.0f) return DecodeStatus::kBadValue;
  message.joints.resize(SizeOf(table.names()));
  for (std::size_t i = 0; i < message.joints.size(); ++i) {
    FURROW_CHECK_DECODE(ReadJoint(table, static_cast<uoffset_t>(i), message.joints[i]));
  }
  FURROW_CHECK_DECODE(ReadTails(table, message.joints));
  FURROW_CHECK_DECODE(
      ReadNames(table.blend_shape_names(), kMaxBlendShapes, message.blend_shape_names));
  message.skeleton_hash = table.skeleton_hash();
  // A wrong hash would bind later poses, which only state the hash, to another skeleton.
  return SkeletonHash(message) == message.skeleton_hash ? DecodeStatus::kOk
                                                        : DecodeStatus::kBadHash;
}

flatbuffers::Offset<wire::SkeletonOffer> WriteTable(PayloadBuilder& payload,
                                                    const SkeletonOffer& message) {
  flatbuffers::FlatBufferBuilder& builder = payload.builder;
  const auto subject = WriteText(payload, message.subject);
  const JointColumns columns = MakeColumns(builder, message.joints);
  const auto names = builder.CreateVector(columns.names);
  const auto parents = builder.CreateVector(columns.parents);
  const auto translations = builder.CreateVectorOfStructs(columns.translations);
  const auto rotations = builder.CreateVectorOfStructs(columns.rotations);
  flatbuffers::Offset<flatbuffers::Vector<const wire::Vec3*>> scales = 0;
  if (columns.has_scales) scales = builder.CreateVectorOfStructs(columns.scales);
  const auto tail_mask = WriteMask(payload, columns.tail_joints, message.joints.size());
  flatbuffers::Offset<flatbuffers::Vector<const wire::Vec3*>> tails = 0;
  if (!columns.tails.empty()) tails = builder.CreateVectorOfStructs(columns.tails);
  const auto shapes = WriteNames(payload, message.blend_shape_names);
  return wire::CreateSkeletonOffer(builder, subject, SkeletonHash(message), message.metres_per_unit,
                                   names, parents, translations, rotations, scales, tail_mask,
                                   tails, shapes);
}

DecodeStatus ReadTable(const wire::SkeletonReply& table, SkeletonReply& message) {
  if (table.status() > wire::SkeletonStatus::MAX) return DecodeStatus::kBadValue;
  message.skeleton_hash = table.skeleton_hash();
  message.status = static_cast<SkeletonStatus>(table.status());
  return ReadText(table.message(), kMaxTextBytes, message.message);
}

flatbuffers::Offset<wire::SkeletonReply> WriteTable(PayloadBuilder& payload,
                                                    const SkeletonReply& message) {
  const auto text = WriteText(payload, message.message);
  return wire::CreateSkeletonReply(payload.builder, message.skeleton_hash,
                                   static_cast<wire::SkeletonStatus>(message.status), text);
}

}  // namespace furrow::protocol::internal
