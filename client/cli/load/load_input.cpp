// SPDX-License-Identifier: Apache-2.0
#include "client/cli/load/load_input.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "base/data_dir.h"
#include "base/status.h"
#include "client/cli/common/inputs.h"
#include "protocol/codec/codec.h"
#include "protocol/framing/fragment.h"
#include "protocol/messages/hash.h"
#include "protocol/messages/quantise.h"
#include "recording/wire_pose.h"
#include "wrinkle/rig/rig_blend_shapes.h"
#include "wrinkle/rig/rig_joints.h"

namespace furrow::cli {
namespace {

// The largest offset of a joint from its rest pose along any axis. Packed translations use it as
// their range.
float Range(std::span<const wrinkle::Transform> locals, std::span<const wrinkle::Transform> rest) {
  float range = 0.0f;
  for (std::size_t j = 0; j < rest.size(); ++j) {
    const glm::vec3 offset = glm::abs(locals[j].translation - rest[j].translation);
    range = std::max({range, offset.x, offset.y, offset.z});
  }
  return range;
}

void QuantiseFrame(std::span<wrinkle::Transform> locals, std::span<const wrinkle::Transform> rest) {
  const float range = Range(locals, rest);
  for (std::size_t j = 0; j < rest.size(); ++j) {
    glm::quat& q = locals[j].rotation;
    protocol::Quat unpacked;
    (void)protocol::UnpackQuat(protocol::PackQuat({q.x, q.y, q.z, q.w}), unpacked);  // just packed
    q = glm::normalize(glm::quat(unpacked.w, unpacked.x, unpacked.y, unpacked.z));
    for (int axis = 0; axis < 3 && range > 0.0f; ++axis) {
      const float offset = locals[j].translation[axis] - rest[j].translation[axis];
      locals[j].translation[axis] =
          rest[j].translation[axis] +
          protocol::UnpackOffset(protocol::PackOffset(offset, range), range);
    }
  }
}

// True if the recording has no joint and no blend shape that the rig reads, by name or by alias.
bool NothingMatches(const wrinkle::Rig& rig, const motion::Clip& clip,
                    const rig::SkeletonMatch& match, const rig::RigShapes& shapes) {
  const auto joints = wrinkle::JointsOf(rig);
  const auto has_joint = [&](const std::string& name) { return joints.contains(name); };
  return match.aliases.empty() && shapes.drivers().num_mapped() == 0 &&
         std::ranges::none_of(clip.skeleton.joint_names(), has_joint) &&
         !wrinkle::ReadsAny(rig, clip.blend_shape_names);
}

// `shapes` receives the blend shapes that the rig reads.
Result<std::shared_ptr<const wrinkle::RigBinding>> BindRig(const LoadInput& input,
                                                           const motion::Clip& clip,
                                                           rig::RigShapes* shapes) {
  std::string rig_name = input.rig;
  if (rig_name.empty()) {
    const auto shipped = furrow::FindDataFile("default.rig.json");
    FURROW_RETURN_IF_ERROR(shipped);
    rig_name = shipped->string();
  }
  const auto loaded = LoadRigInput(rig_name, input.read, input.skeleton_map);
  FURROW_RETURN_IF_ERROR(loaded);
  const wrinkle::Rig& rig = loaded->rig;
  const auto matcher = LoadSkeletonMatcher(input.skeleton_map, loaded->character.get());
  FURROW_RETURN_IF_ERROR(matcher);
  const auto match = MatchJoints(*matcher, clip, rig, loaded->skeleton());
  const auto shape_matcher = LoadShapeMatcher(input.shape_map);
  FURROW_RETURN_IF_ERROR(shape_matcher);
  const auto moved = MatchFaceJoints(*shape_matcher, clip, match, loaded->character.get());
  *shapes = MatchBlendShapes(*shape_matcher, clip, rig, moved);
  auto binding = wrinkle::RigBinding::Create(rig, clip.skeleton, shapes->driver_names(),
                                             match.Options(/*allow_missing=*/true));
  if (!binding.ok()) return binding.status().At(rig_name);
  if (moved.solver == nullptr && NothingMatches(rig, clip, match, *shapes)) {
    return Status(StatusCode::kNotFound, "the recording has no joint and no blend shape of the rig",
                  input.file,
                  "all weights would stay at 0; choose a --rig for this recording, or map its "
                  "joints with --skeleton-map and its blend shapes with --shape-map");
  }
  WarnAboutMissing(*binding, clip);
  return std::make_shared<const wrinkle::RigBinding>(*std::move(binding));
}

protocol::PoseEncoding EncodingOf(Packing packing) {
  switch (packing) {
    case Packing::kAlways: return protocol::PoseEncoding::Small();
    case Packing::kToFit: return protocol::PoseEncoding::Fitting();
    case Packing::kNever: break;
  }
  return {};
}

}  // namespace

void QuantiseClip(Packing packing, motion::Clip* clip) {
  if (packing == Packing::kNever) return;
  const auto rest = clip->skeleton.rest_pose();
  const std::size_t shapes = clip->blend_shape_names.size();
  protocol::Encoder encoder;
  protocol::PoseFrame pose;
  std::vector<std::uint8_t> message;
  for (int frame = 0; frame < clip->num_frames(); ++frame) {
    if (packing == Packing::kToFit) {
      recording::FillPose(*clip, frame, &pose);
      encoder.Encode({.session = 1}, pose, message);
      if (protocol::NumDatagrams(message.size()) == 1) continue;
    }
    const auto at = static_cast<std::size_t>(frame);
    QuantiseFrame(std::span(clip->locals).subspan(rest.size() * at, rest.size()), rest);
    for (float& value : std::span(clip->blend_shapes).subspan(shapes * at, shapes))
      value = protocol::UnpackBlendShape(protocol::PackBlendShape(value));
  }
}

Result<load::Workload> LoadWorkload(const LoadInput& input) {
  auto loaded = LoadClipArgument(input.file, input.read);
  FURROW_RETURN_IF_ERROR(loaded);
  if (loaded->num_frames() == 0)
    return Status(StatusCode::kInvalidArgument, "the recording has no frames", input.file);
  QuantiseClip(input.packing, &*loaded);
  const auto clip = std::make_shared<const motion::Clip>(*std::move(loaded));
  rig::RigShapes shapes;
  auto binding = BindRig(input, *clip, &shapes);
  FURROW_RETURN_IF_ERROR(binding);

  load::Workload workload;
  workload.offer = recording::OfferOf(*clip, clip->name, input.scale);
  workload.times = clip->times;
  workload.binding = *std::move(binding);
  workload.pose = [clip, shapes](int frame, wrinkle::LocalPose* pose) {
    clip->GetPose(frame, pose);
    shapes.Extend(pose);
  };
  const auto encoding = EncodingOf(input.packing);
  protocol::Encoder encoder;
  protocol::PoseFrame pose;
  pose.skeleton_hash = protocol::SkeletonHash(workload.offer);
  for (int frame = 0; frame < clip->num_frames(); ++frame) {
    recording::FillPose(*clip, frame, &pose);
    encoder.Encode({.session = 1}, pose, workload.messages.emplace_back(), encoding);
  }
  return workload;
}

}  // namespace furrow::cli
