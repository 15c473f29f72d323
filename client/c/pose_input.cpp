// SPDX-License-Identifier: Apache-2.0
#include "client/c/pose_input.h"

#include <cmath>
#include <cstring>
#include <numeric>

#include "base/text.h"
#include "client/c/struct_copy.h"
#include "client/c/text_input.h"
#include "protocol/messages/limits.h"

namespace furrow::capi {
namespace {

using protocol::Quat;
using protocol::Vec3;

Status Invalid(std::string what, std::string todo = {}) {
  return {StatusCode::kInvalidArgument, std::move(what), {}, std::move(todo)};
}

// "joint 3 ('head')"
std::string NameOf(std::size_t joint, const std::string& name) {
  return "joint " + std::to_string(joint) + " (" + Quoted(name) + ")";
}

bool IsNumber(float value) {
  return std::isfinite(value) && std::abs(value) <= protocol::kMaxMagnitude;
}

bool AreNumbers(const float* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    if (!IsNumber(values[i])) return false;
  }
  return true;
}

// Programs keep rotations that drift away from length 1, so the length is corrected here.
bool ReadRotation(const float* xyzw, Quat* rotation) {
  if (!AreNumbers(xyzw, 4)) return false;
  const double length = std::sqrt(double{xyzw[0]} * xyzw[0] + double{xyzw[1]} * xyzw[1] +
                                  double{xyzw[2]} * xyzw[2] + double{xyzw[3]} * xyzw[3]);
  if (length < 1e-6) return false;
  *rotation = {static_cast<float>(xyzw[0] / length), static_cast<float>(xyzw[1] / length),
               static_cast<float>(xyzw[2] / length), static_cast<float>(xyzw[3] / length)};
  return true;
}

bool ReadName(const char* text, std::string* name) {
  return ReadText(text, protocol::kMaxNameBytes, name) && !name->empty();
}

constexpr char kNameRule[] = "use 1 to 255 bytes of UTF-8 without control characters";

Status ReadJoint(const furrow_joint& from, std::size_t index, protocol::OfferedJoint* joint) {
  if (!ReadName(from.name, &joint->name)) {
    return Invalid("the name of joint " + std::to_string(index) + " is invalid", kNameRule);
  }
  if (from.parent < -1 || from.parent >= static_cast<std::int64_t>(index)) {
    return Invalid(NameOf(index, joint->name) + " has the parent " + std::to_string(from.parent),
                   "use -1, or the index of an earlier joint");
  }
  joint->parent = static_cast<std::int16_t>(from.parent);
  if (!AreNumbers(from.translation, 3) || !AreNumbers(from.scale, 3)) {
    return Invalid(NameOf(index, joint->name) + " has a translation or scale that is not a number",
                   "use finite numbers of at most 1e6");
  }
  if (!ReadRotation(from.rotation, &joint->rest_rotation)) {
    return Invalid(NameOf(index, joint->name) + " has a rotation of length 0, or not a number",
                   "use 0, 0, 0, 1 for no rotation");
  }
  joint->rest_translation = {from.translation[0], from.translation[1], from.translation[2]};
  const bool scaled = from.scale[0] != 0.0f || from.scale[1] != 0.0f || from.scale[2] != 0.0f;
  if (scaled) joint->rest_scale = {from.scale[0], from.scale[1], from.scale[2]};
  return {};
}

Status ReadJoints(const furrow_skeleton& skeleton, protocol::SkeletonOffer* offer) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(skeleton.joints);
  const std::size_t stride = skeleton.joint_size;
  if (bytes == nullptr) return Invalid("joints is null, but num_joints is above 0");
  if (stride < sizeof(furrow_joint) || stride > kMostStructBytes) {
    return Invalid("joint_size is wrong", "set it to sizeof(furrow_joint)");
  }
  offer->joints.resize(skeleton.num_joints);
  for (std::size_t i = 0; i < skeleton.num_joints; ++i, bytes += stride) {
    furrow_joint joint;
    std::memcpy(&joint, bytes, sizeof joint);
    for (std::size_t extra = sizeof joint; extra < stride; ++extra) {
      if (bytes[extra] == 0) continue;
      return {StatusCode::kUnsupported, "a joint has a field that this version does not know"};
    }
    FURROW_RETURN_IF_ERROR(ReadJoint(joint, i, &offer->joints[i]));
  }
  return {};
}

Status ReadBlendShapes(const furrow_skeleton& skeleton, protocol::SkeletonOffer* offer) {
  if (skeleton.blend_shapes == nullptr) {
    return Invalid("blend_shapes is null, but num_blend_shapes is above 0");
  }
  offer->blend_shape_names.resize(skeleton.num_blend_shapes);
  for (std::size_t i = 0; i < skeleton.num_blend_shapes; ++i) {
    if (!ReadName(skeleton.blend_shapes[i], &offer->blend_shape_names[i])) {
      return Invalid("the name of blend shape " + std::to_string(i) + " is invalid", kNameRule);
    }
  }
  return {};
}

template <class T>
void ListAll(std::size_t count, std::vector<T>* indices) {
  indices->resize(count);
  std::iota(indices->begin(), indices->end(), T{0});
}

}  // namespace

Result<protocol::SkeletonOffer> ReadSkeleton(const furrow_skeleton& skeleton) {
  protocol::SkeletonOffer offer;
  if (!ReadName(skeleton.subject, &offer.subject)) {
    return Invalid("the name of the subject is invalid", kNameRule);
  }
  if (skeleton.num_joints > protocol::kMaxJoints ||
      skeleton.num_blend_shapes > protocol::kMaxBlendShapes) {
    return Status(StatusCode::kLimit, "too many joints or blend shapes", {},
                  "at most 1,024 joints and 512 blend shapes are possible");
  }
  if (skeleton.num_joints == 0 && skeleton.num_blend_shapes == 0) {
    return Invalid("the skeleton has neither joints nor blend shapes");
  }
  if (skeleton.reserved != 0) return Status(StatusCode::kUnsupported, "reserved is not 0");
  if (skeleton.metres_per_unit != 0.0f) offer.metres_per_unit = skeleton.metres_per_unit;
  if (!IsNumber(offer.metres_per_unit) || offer.metres_per_unit < 0.0f) {
    return Invalid("metres_per_unit is not a positive number");
  }
  if (skeleton.num_joints > 0) FURROW_RETURN_IF_ERROR(ReadJoints(skeleton, &offer));
  if (skeleton.num_blend_shapes > 0) FURROW_RETURN_IF_ERROR(ReadBlendShapes(skeleton, &offer));
  return offer;
}

PoseReader::PoseReader(const protocol::SkeletonOffer& offer)
    : num_blend_shapes_(offer.blend_shape_names.size()) {
  for (const protocol::OfferedJoint& joint : offer.joints) {
    rest_translations_.push_back(joint.rest_translation);
  }
}

Status PoseReader::ReadRotations(const float* values, protocol::PoseFrame* pose) const {
  const std::size_t count = rest_translations_.size();
  ListAll(count, &pose->rotation_joints);
  pose->rotations.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (!ReadRotation(values + 4 * i, &pose->rotations[i])) {
      return Invalid("rotation " + std::to_string(i) + " has length 0, or is not a number");
    }
  }
  return {};
}

Status PoseReader::ReadTranslations(const float* values, protocol::PoseFrame* pose) const {
  const std::size_t count = rest_translations_.size();
  ListAll(count, &pose->translation_joints);
  pose->translations.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float* const local = values + 3 * i;
    // The wire carries offsets from the rest pose.
    const Vec3& rest = rest_translations_[i];
    const Vec3 offset{local[0] - rest.x, local[1] - rest.y, local[2] - rest.z};
    if (!IsNumber(offset.x) || !IsNumber(offset.y) || !IsNumber(offset.z)) {
      return Invalid("translation " + std::to_string(i) + " is not a number, or above 1e6");
    }
    pose->translations[i] = offset;
  }
  return {};
}

Status PoseReader::Read(const furrow_pose& input, protocol::PoseFrame* pose) const {
  constexpr std::int64_t kMostTime = std::int64_t{1} << 62;
  *pose = {};
  pose->num_joints = static_cast<std::uint16_t>(rest_translations_.size());
  pose->num_blend_shapes = static_cast<std::uint16_t>(num_blend_shapes_);
  if (input.capture_time_us <= -kMostTime || input.capture_time_us >= kMostTime) {
    return Invalid("capture_time_us is outside of 62 bits");
  }
  if (input.rotations != nullptr) FURROW_RETURN_IF_ERROR(ReadRotations(input.rotations, pose));
  if (input.translations != nullptr) {
    FURROW_RETURN_IF_ERROR(ReadTranslations(input.translations, pose));
  }
  if (input.scales != nullptr) {
    const std::size_t count = rest_translations_.size();
    if (!AreNumbers(input.scales, 3 * count)) {
      return Invalid("a scale is not a number, or above 1e6");
    }
    ListAll(count, &pose->scale_joints);
    for (std::size_t i = 0; i < count; ++i) {
      const float* const scale = input.scales + 3 * i;
      pose->scales.push_back({scale[0], scale[1], scale[2]});
    }
  }
  if (input.blend_shapes != nullptr) {
    if (!AreNumbers(input.blend_shapes, num_blend_shapes_)) {
      return Invalid("a blend shape is not a number, or above 1e6");
    }
    ListAll(num_blend_shapes_, &pose->blend_shape_indices);
    pose->blend_shapes.assign(input.blend_shapes, input.blend_shapes + num_blend_shapes_);
  }
  return {};
}

}  // namespace furrow::capi
