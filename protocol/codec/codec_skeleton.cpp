// SPDX-License-Identifier: Apache-2.0
// SkeletonOffer and SkeletonReply: STANDARD.md section 6.
#include "protocol/codec/codec_internal.h"
#include "protocol/messages/hash.h"
#include "protocol/schema/skeleton_offer_generated.h"
#include "protocol/schema/skeleton_reply_generated.h"

namespace furrow::protocol {
namespace {

using flatbuffers::uoffset_t;
using internal::Builder;
using internal::SizeOf;

Vec3 FromWire(const wire::Vec3& v) { return {v.x(), v.y(), v.z()}; }
Quat FromWire(const wire::Quat& q) { return {q.x(), q.y(), q.z(), q.w()}; }
wire::Vec3 ToWire(const Vec3& v) { return {v.x, v.y, v.z}; }
wire::Quat ToWire(const Quat& q) { return {q.x, q.y, q.z, q.w}; }

DecodeStatus CheckCounts(const wire::SkeletonOffer& root) {
  const std::size_t joints = SizeOf(root.names());
  if (joints > kMaxJoints) return DecodeStatus::kLimit;
  if (joints + SizeOf(root.blend_shape_names()) == 0) return DecodeStatus::kMissingField;
  const bool equal = SizeOf(root.parents()) == joints &&
                     SizeOf(root.rest_translations()) == joints &&
                     SizeOf(root.rest_rotations()) == joints &&
                     (root.rest_scales() == nullptr || root.rest_scales()->size() == joints);
  return equal ? DecodeStatus::kOk : DecodeStatus::kBadCount;
}

DecodeStatus ReadJoint(const wire::SkeletonOffer& root, uoffset_t i, OfferedJoint& joint) {
  joint.name.assign(root.names()->Get(i)->c_str(), root.names()->Get(i)->size());
  joint.parent = root.parents()->Get(i);
  if (joint.parent < -1 || joint.parent >= static_cast<int>(i)) return DecodeStatus::kBadValue;
  joint.rest_translation = FromWire(*root.rest_translations()->Get(i));
  joint.rest_rotation = FromWire(*root.rest_rotations()->Get(i));
  joint.rest_scale =
      root.rest_scales() == nullptr ? Vec3{1, 1, 1} : FromWire(*root.rest_scales()->Get(i));
  joint.has_tail = false;
  joint.tail = {};
  FURROW_CHECK_DECODE(internal::CheckVector(joint.rest_translation));
  FURROW_CHECK_DECODE(internal::CheckVector(joint.rest_scale));
  return internal::CheckRotation(joint.rest_rotation);
}

DecodeStatus ReadTails(const wire::SkeletonOffer& root, std::vector<OfferedJoint>& joints) {
  std::vector<std::uint16_t> indices;
  const std::size_t num_tails = SizeOf(root.tails());
  FURROW_CHECK_DECODE(internal::ReadMask(root.tail_mask(), joints.size(), num_tails, indices));
  for (std::size_t i = 0; i < num_tails; ++i) {
    OfferedJoint& joint = joints[indices[i]];
    joint.has_tail = true;
    joint.tail = FromWire(*root.tails()->Get(static_cast<uoffset_t>(i)));
    FURROW_CHECK_DECODE(internal::CheckVector(joint.tail));
  }
  return DecodeStatus::kOk;
}

struct JointVectors {
  std::vector<flatbuffers::Offset<flatbuffers::String>> names;
  std::vector<std::int16_t> parents;
  std::vector<wire::Vec3> translations;
  std::vector<wire::Quat> rotations;
  std::vector<wire::Vec3> scales;
  bool has_scales = false;
  std::vector<std::uint16_t> tail_joints;
  std::vector<wire::Vec3> tails;
};

JointVectors Gather(Builder& builder, const std::vector<OfferedJoint>& joints) {
  JointVectors all;
  for (const OfferedJoint& joint : joints) {
    all.names.push_back(builder.CreateString(joint.name));
    all.parents.push_back(joint.parent);
    all.translations.push_back(ToWire(joint.rest_translation));
    all.rotations.push_back(ToWire(joint.rest_rotation));
    all.scales.push_back(ToWire(joint.rest_scale));
    all.has_scales |= joint.rest_scale != Vec3{1, 1, 1};
    if (joint.has_tail) {
      all.tail_joints.push_back(static_cast<std::uint16_t>(all.names.size() - 1));
      all.tails.push_back(ToWire(joint.tail));
    }
  }
  return all;
}

}  // namespace

DecodeStatus Decode(const MessageView& view, SkeletonOffer& message) {
  const wire::SkeletonOffer* root = nullptr;
  FURROW_CHECK_DECODE(internal::Verify(view, MessageKind::kSkeletonOffer, root));
  FURROW_CHECK_DECODE(CheckCounts(*root));
  FURROW_CHECK_DECODE(internal::ReadText(root->subject(), kMaxNameBytes, message.subject,
                                         internal::Presence::kRequired));
  FURROW_CHECK_DECODE(internal::CheckNames(root->names(), kMaxJoints));
  message.metres_per_unit = root->metres_per_unit();
  FURROW_CHECK_DECODE(internal::CheckNumber(message.metres_per_unit));
  if (message.metres_per_unit <= 0.0f) return DecodeStatus::kBadValue;
  message.joints.resize(SizeOf(root->names()));
  for (std::size_t i = 0; i < message.joints.size(); ++i) {
    FURROW_CHECK_DECODE(ReadJoint(*root, static_cast<uoffset_t>(i), message.joints[i]));
  }
  FURROW_CHECK_DECODE(ReadTails(*root, message.joints));
  FURROW_CHECK_DECODE(
      internal::ReadNames(root->blend_shape_names(), kMaxBlendShapes, message.blend_shape_names));
  message.skeleton_hash = root->skeleton_hash();
  return SkeletonHash(message) == message.skeleton_hash ? DecodeStatus::kOk
                                                        : DecodeStatus::kBadHash;
}

void Encoder::Encode(const Header& header, const SkeletonOffer& message,
                     std::vector<std::uint8_t>& out) {
  Builder& builder = state_->builder;
  builder.Clear();
  const auto subject = internal::WriteText(builder, message.subject);
  const JointVectors all = Gather(builder, message.joints);
  const auto names = builder.CreateVector(all.names);
  const auto parents = builder.CreateVector(all.parents);
  const auto translations = builder.CreateVectorOfStructs(all.translations);
  const auto rotations = builder.CreateVectorOfStructs(all.rotations);
  flatbuffers::Offset<flatbuffers::Vector<const wire::Vec3*>> scales = 0;
  if (all.has_scales) scales = builder.CreateVectorOfStructs(all.scales);
  const auto tail_mask = internal::WriteMask(*state_, all.tail_joints, message.joints.size());
  flatbuffers::Offset<flatbuffers::Vector<const wire::Vec3*>> tails = 0;
  if (!all.tails.empty()) tails = builder.CreateVectorOfStructs(all.tails);
  flatbuffers::Offset<internal::TextVector> shapes = 0;
  if (!message.blend_shape_names.empty()) {
    shapes = builder.CreateVectorOfStrings(message.blend_shape_names);
  }
  internal::Finish(builder,
                   wire::CreateSkeletonOffer(builder, subject, SkeletonHash(message),
                                             message.metres_per_unit, names, parents, translations,
                                             rotations, scales, tail_mask, tails, shapes),
                   header, MessageKind::kSkeletonOffer, out);
}

DecodeStatus Decode(const MessageView& view, SkeletonReply& message) {
  const wire::SkeletonReply* root = nullptr;
  FURROW_CHECK_DECODE(internal::Verify(view, MessageKind::kSkeletonReply, root));
  if (root->status() > wire::SkeletonStatus::MAX) return DecodeStatus::kBadValue;
  message.skeleton_hash = root->skeleton_hash();
  message.status = static_cast<SkeletonStatus>(root->status());
  return internal::ReadText(root->message(), kMaxTextBytes, message.message);
}

void Encoder::Encode(const Header& header, const SkeletonReply& message,
                     std::vector<std::uint8_t>& out) {
  Builder& builder = state_->builder;
  builder.Clear();
  const auto text = internal::WriteText(builder, message.message);
  const auto status = static_cast<wire::SkeletonStatus>(message.status);
  internal::Finish(builder, wire::CreateSkeletonReply(builder, message.skeleton_hash, status, text),
                   header, MessageKind::kSkeletonReply, out);
}

}  // namespace furrow::protocol
