// SPDX-License-Identifier: Apache-2.0
#include "recording/take_clip.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "base/status.h"
#include "motion/clip/limits.h"
#include "recording/wire_quat.h"

namespace furrow::recording {
namespace {

glm::vec3 ToVec(const protocol::Vec3& v) { return {v.x, v.y, v.z}; }

// Calls `use(index, value)` for each value. An empty list of indices means 0, 1, 2 and so on.
template <class Value, class Use>
void ForEachIndexed(std::span<const std::uint16_t> indices, std::span<const Value> values,
                    const Use& use) {
  for (std::size_t i = 0; i < values.size(); ++i) use(indices.empty() ? i : indices[i], values[i]);
}

// The current pose of a stream, with joints in the skeleton's order.
// Wire poses may be partial, clips hold whole poses, so this keeps the last value of every joint.
class RunningPose {
 public:
  RunningPose(const wrinkle::Skeleton& skeleton, std::size_t num_shapes, float scale)
      : skeleton_(skeleton),
        scale_(scale),
        place_(static_cast<std::size_t>(skeleton.num_joints())),
        joints_(skeleton.rest_pose().begin(), skeleton.rest_pose().end()),
        shapes_(num_shapes, 0.0f) {
    // The skeleton may order joints differently than the offer, which the wire's indices refer to.
    for (std::size_t j = 0; j < place_.size(); ++j)
      place_[static_cast<std::size_t>(skeleton.source_index()[j])] = j;
  }

  void Apply(const protocol::PoseFrame& pose) {
    const auto rest = skeleton_.rest_pose();
    if (!pose.partial) {
      std::ranges::copy(rest, joints_.begin());
      std::ranges::fill(shapes_, 0.0f);
    }
    ForEachIndexed<protocol::Quat>(pose.rotation_joints, pose.rotations,
                                   [&](std::size_t i, const protocol::Quat& value) {
                                     joints_[place_[i]].rotation = ToUnitQuat(value);
                                   });
    ForEachIndexed<protocol::Vec3>(pose.translation_joints, pose.translations,
                                   [&](std::size_t i, const protocol::Vec3& value) {
                                     const std::size_t joint = place_[i];
                                     joints_[joint].translation =
                                         rest[joint].translation + scale_ * ToVec(value);
                                   });
    ForEachIndexed<protocol::Vec3>(pose.scale_joints, pose.scales,
                                   [&](std::size_t i, const protocol::Vec3& value) {
                                     joints_[place_[i]].scale = ToVec(value);
                                   });
    ForEachIndexed<float>(pose.blend_shape_indices, pose.blend_shapes,
                          [&](std::size_t i, float value) { shapes_[i] = value; });
  }

  [[nodiscard]] const std::vector<wrinkle::Transform>& joints() const { return joints_; }
  [[nodiscard]] const std::vector<float>& shapes() const { return shapes_; }

 private:
  const wrinkle::Skeleton& skeleton_;
  float scale_;
  std::vector<std::size_t> place_;  // per joint of the offer: its index in the skeleton
  std::vector<wrinkle::Transform> joints_;
  std::vector<float> shapes_;
};

}  // namespace

Result<wrinkle::Skeleton> SkeletonOf(const protocol::SkeletonOffer& offer, float scale) {
  if (offer.joints.empty()) return wrinkle::Skeleton();
  std::vector<wrinkle::JointDesc> joints;
  for (const protocol::OfferedJoint& joint : offer.joints) {
    wrinkle::JointDesc& desc = joints.emplace_back();
    desc.name = joint.name;
    desc.parent = joint.parent < 0 ? wrinkle::kNoJoint : joint.parent;
    desc.rest = {.translation = scale * ToVec(joint.rest_translation),
                 .rotation = ToUnitQuat(joint.rest_rotation),
                 .scale = ToVec(joint.rest_scale)};
    if (joint.has_tail) desc.tail = scale * ToVec(joint.tail);
  }
  return wrinkle::Skeleton::Create(std::move(joints));
}

Result<motion::Clip> ToClip(const TakePoses& poses, float scale) {
  const protocol::SkeletonOffer& offer = poses.offer();
  // Before any allocation: a take of small partial poses expands to whole ones.
  if (poses.size() * std::max<std::size_t>(offer.joints.size(), 1) > motion::kMaxTransforms ||
      poses.size() * offer.blend_shape_names.size() > motion::kMaxBlendShapeValues) {
    return Status(StatusCode::kLimit,
                  "the take has " + std::to_string(poses.size()) + " poses of " +
                      std::to_string(offer.joints.size()) + " joints and " +
                      std::to_string(offer.blend_shape_names.size()) +
                      " blend shapes; a clip holds at most " +
                      std::to_string(motion::kMaxTransforms) + " joint transforms and " +
                      std::to_string(motion::kMaxBlendShapeValues) + " blend-shape values",
                  {}, "record with --rotate-seconds for shorter files");
  }
  auto skeleton = SkeletonOf(offer, scale);
  FURROW_RETURN_IF_ERROR(skeleton);
  motion::Clip clip;
  clip.name = offer.subject;
  clip.skeleton = *std::move(skeleton);
  clip.blend_shape_names = offer.blend_shape_names;
  clip.times.assign(poses.times().begin(), poses.times().end());
  RunningPose running(clip.skeleton, offer.blend_shape_names.size(), scale);
  protocol::PoseFrame pose;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses.Get(i, &pose);
    running.Apply(pose);
    clip.timecodes.push_back(pose.timecode);
    clip.locals.insert(clip.locals.end(), running.joints().begin(), running.joints().end());
    clip.blend_shapes.insert(clip.blend_shapes.end(), running.shapes().begin(),
                             running.shapes().end());
  }
  const auto has_one = [](const std::optional<Timecode>& timecode) { return timecode.has_value(); };
  if (std::ranges::none_of(clip.timecodes, has_one)) clip.timecodes.clear();
  return clip;
}

Result<motion::Clip> LoadTakeClip(const std::string& path, float scale, motion::ClipReport* report,
                                  ReadProgress progress) {
  std::string file;
  std::string subject;
  SplitTakePath(path, &file, &subject);
  auto take = TakeReader::Open(file);
  FURROW_RETURN_IF_ERROR(take);
  (*take)->set_progress(std::move(progress));
  const auto poses = TakePoses::Load(**take, subject, report);
  FURROW_RETURN_IF_ERROR(poses);
  auto clip = ToClip(*poses, scale);
  if (!clip.ok()) return clip.status().At(file);
  return clip;
}

Result<motion::Clip> ParseTakeClip(std::span<const std::uint8_t> bytes, const std::string& name,
                                   motion::ClipReport* report) {
  auto take = TakeReader::OpenBytes(bytes, name);
  FURROW_RETURN_IF_ERROR(take);
  const auto subjects = TakePoses::LoadAll(**take, {}, report);
  FURROW_RETURN_IF_ERROR(subjects);
  const std::string& first = subjects->front().offer().subject;
  if (subjects->size() > 1 && report != nullptr) {
    report->warnings.push_back(name + ": holds " + std::to_string(subjects->size()) +
                               " subjects, of which the first is used, '" + first + "'");
  }
  auto clip = ToClip(subjects->front());
  if (!clip.ok()) return clip.status().At(name);
  return clip;
}

}  // namespace furrow::recording
