// SPDX-License-Identifier: Apache-2.0
#include "recording/take_clip.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/status.h"
#include "motion/clip/limits.h"
#include "recording/wire_joints.h"
#include "wrinkle/skeleton/pose.h"

namespace furrow::recording {
namespace {

// Per joint of an offer, which the wire's indices refer to: its index in the skeleton, which may
// order joints differently.
std::vector<std::int16_t> JointOfWire(const wrinkle::Skeleton& skeleton) {
  const auto source = skeleton.source_index();
  std::vector<std::int16_t> joint_of_wire(source.size());
  for (std::size_t j = 0; j < source.size(); ++j) {
    joint_of_wire[static_cast<std::size_t>(source[j])] = static_cast<std::int16_t>(j);
  }
  return joint_of_wire;
}

}  // namespace

Result<wrinkle::Skeleton> SkeletonOf(const protocol::SkeletonOffer& offer, float scale) {
  if (offer.joints.empty()) return wrinkle::Skeleton();
  return wrinkle::Skeleton::Create(JointsOf(offer, scale));
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
  const std::vector<std::int16_t> joint_of_wire = JointOfWire(clip.skeleton);
  const WireTarget target{clip.skeleton.rest_pose(), joint_of_wire, scale};
  // Wire poses may be partial, clips hold whole poses, so this keeps the last value of every joint.
  wrinkle::LocalPose running;
  running.SetRest(clip.skeleton);
  running.blend_shapes.assign(offer.blend_shape_names.size(), 0.0f);
  protocol::PoseFrame pose;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses.Get(i, &pose);
    ApplyWirePose(pose, target, running.joints, running.blend_shapes);
    clip.timecodes.push_back(pose.timecode);
    clip.locals.insert(clip.locals.end(), running.joints.begin(), running.joints.end());
    clip.blend_shapes.insert(clip.blend_shapes.end(), running.blend_shapes.begin(),
                             running.blend_shapes.end());
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
