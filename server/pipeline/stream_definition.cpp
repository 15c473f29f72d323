// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/stream_definition.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>

#include "base/status.h"
#include "rig/shapes/face_joints.h"
#include "wrinkle/rig/rig_blend_shapes.h"

namespace furrow::server {
namespace {

constexpr std::size_t kMaxWarnings = 8;  // of one binding that are logged one by one

// "a, b and 3 more". The names come from senders, so a log line has a limit.
std::string Join(std::span<const std::string> names, std::size_t at_most = 12) {
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < at_most; ++i) {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  if (names.size() > at_most) text += " and " + std::to_string(names.size() - at_most) + " more";
  return text;
}

// The hash covers the sorted skeleton. Streams with other wire orders need their own joint_of_wire.
bool SameOrder(const wrinkle::Skeleton& a, const wrinkle::Skeleton& b) {
  return std::ranges::equal(a.source_index(), b.source_index());
}

// How the names of the stream were matched.
void LogMatch(const rig::SkeletonMatch& match, const StreamDefinition& stream) {
  if (const std::string text = rig::Describe(match); !text.empty()) {
    spdlog::info("{}", text);
  }
  for (const std::string& warning : rig::WarningsOf(match)) spdlog::warn("{}", warning);
  if (const std::string text = stream.shapes.Description(); !text.empty()) {
    spdlog::info("{}", text);
  }
  if (!stream.face_match.empty()) spdlog::info("face: {}", stream.face_match);
  if (stream.joint_shapes != nullptr) spdlog::info("{}", stream.joint_shapes->Description());
}

// What the binding warns about, and what the stream lacks.
void LogFaults(const StreamDefinition& stream) {
  const auto warnings = stream.binding->warnings();
  for (std::size_t i = 0; i < std::min(warnings.size(), kMaxWarnings); ++i) {
    spdlog::warn("{}", warnings[i]);
  }
  if (warnings.size() > kMaxWarnings) {
    spdlog::warn("{} more warnings of this kind; 'furrow rig check --skeleton' lists all",
                 warnings.size() - kMaxWarnings);
  }
  const auto joints = stream.binding->missing_joints();
  const auto shapes = stream.binding->missing_blend_shapes();
  // A stream without any joints comes from a face tracker, and one without any blend shapes from a
  // body tracker; nothing is missing.
  if (!joints.empty() && stream.skeleton.num_joints() > 0) {
    spdlog::warn("the stream lacks joints that the rig uses; their drivers stay at rest: {}",
                 Join(joints));
  }
  if (!shapes.empty() && !stream.blend_shapes.empty()) {
    spdlog::warn("the stream lacks blend shapes that the rig uses; their drivers stay at rest: {}",
                 Join(shapes));
  }
}

struct JointUse {
  std::vector<std::string> ignored;  // neither drawn, nor read, nor moving a shape
  bool draws_any = false;            // a joint of the character follows one of the stream
  bool feeds_any = false;            // the rig reads one
};

JointUse FindJointUse(const StreamDefinition& stream, const rig::SkeletonMatch& match,
                      const std::set<std::string>& rig_joints) {
  JointUse use;
  const auto unmatched =
      stream.retarget ? stream.retarget->unmatched_source() : std::span<const std::string>();
  for (const std::string& name : stream.skeleton.joint_names()) {
    const bool drawn = stream.retarget && std::ranges::find(unmatched, name) == unmatched.end();
    const bool read = rig_joints.contains(name) || match.Reads(name);
    const bool moves =
        stream.joint_shapes != nullptr && stream.joint_shapes->Moves(stream.skeleton.Find(name));
    if (!drawn && !read && !moves) use.ignored.push_back(name);
    use.draws_any |= drawn;
    use.feeds_any |= read;
  }
  return use;
}

// True if something of the character moves without a joint of its skeleton.
bool DrawsShapes(const StreamDefinition& stream) {
  return (stream.blend_shape_pose != nullptr && !stream.blend_shape_pose->empty()) ||
         (stream.shape_program != nullptr && !stream.shape_program->empty()) ||
         (stream.head_turn != nullptr && !stream.head_turn->empty());
}

}  // namespace

Result<std::shared_ptr<const StreamDefinition>> StreamDefinitions::Get(
    StreamOffer offer, const std::function<bool()>& may_make) {
  wrinkle::Skeleton skeleton;
  if (!offer.joints.empty()) {
    auto created = wrinkle::Skeleton::Create(std::move(offer.joints));
    FURROW_RETURN_IF_ERROR(created);
    skeleton = *std::move(created);
  }
  return FindOrMake(std::move(skeleton), std::move(offer.blend_shapes), may_make);
}

void StreamDefinitions::SetRig(std::shared_ptr<const wrinkle::Rig> rig) {
  rig_ = std::move(rig);
  rig_joints_ = wrinkle::JointsOf(*rig_);
  // The definitions are bound to the old rig. Subjects that use one keep it alive until Rebind().
  known_.clear();
}

StreamMaps StreamDefinitions::SetMaps(StreamMaps maps) {
  known_.clear();  // those of the old maps
  return std::exchange(maps_, std::move(maps));
}

void StreamDefinitions::SetCapacity(std::size_t capacity) {
  capacity_ = capacity;
  while (known_.size() > capacity_) known_.pop_back();
}

Result<std::shared_ptr<const StreamDefinition>> StreamDefinitions::Rebind(
    const StreamDefinition& stream) {
  // Not limited: the number of subjects bounds the work, and SetRig() must reach all of them.
  return FindOrMake(stream.skeleton, stream.blend_shapes, [] { return true; });
}

Result<std::shared_ptr<const StreamDefinition>> StreamDefinitions::FindOrMake(
    wrinkle::Skeleton skeleton, std::vector<std::string> blend_shapes,
    const std::function<bool()>& may_make) {
  const auto is_same = [&](const std::shared_ptr<const StreamDefinition>& known) {
    return known->skeleton.hash() == skeleton.hash() && SameOrder(known->skeleton, skeleton) &&
           known->blend_shapes == blend_shapes;
  };
  const auto known = std::find_if(known_.begin(), known_.end(), is_same);
  if (known != known_.end()) {
    // To the front: the list is in the order of use.
    known_.splice(known_.begin(), known_, known);
    return known_.front();
  }
  if (!may_make()) return std::shared_ptr<const StreamDefinition>();
  auto made = Make(std::move(skeleton), std::move(blend_shapes));
  if (!made.ok()) return made;
  known_.push_front(*made);
  if (known_.size() > capacity_) known_.pop_back();  // subjects that use it keep it alive
  return made;
}

Result<std::shared_ptr<const StreamDefinition>> StreamDefinitions::Make(
    wrinkle::Skeleton skeleton, std::vector<std::string> blend_shapes) {
  // Finds the skeleton map whose joint names fit, and by it the joints of the rig.
  rig::SkeletonMatch match = maps_.skeletons.Match(skeleton, *rig_, character_.skeleton);
  auto definition = std::make_shared<StreamDefinition>();
  // The character has its own skeleton: the pose is carried over joint by joint.
  if (character_.skeleton != nullptr) {
    definition->retarget = std::make_shared<const wrinkle::Retarget>(
        rig::MakeRetarget(match, skeleton, *character_.skeleton));
    definition->joint_shapes = MatchJointShapes(skeleton, blend_shapes, match, *definition);
  }
  // The same for the names of blend shapes.
  rig::RigShapes shapes(maps_.shapes, blend_shapes, *rig_,
                        {definition->joint_shapes, character_.shapes});
  // Live streams may lack joints and blend shapes. Their drivers rest, and Report() names them.
  auto binding = wrinkle::RigBinding::Create(*rig_, skeleton, shapes.driver_names(),
                                             match.Options(/*allow_missing=*/true));
  FURROW_RETURN_IF_ERROR(binding);
  definition->joint_of_wire.resize(static_cast<std::size_t>(skeleton.num_joints()));
  for (int joint = 0; joint < skeleton.num_joints(); ++joint) {
    definition->joint_of_wire[static_cast<std::size_t>(skeleton.source_index()[joint])] =
        static_cast<std::int16_t>(joint);
  }
  // Blend shapes move the character through its own shapes or, where it has none of the name,
  // through the rig's poses.
  if (character_.skeleton != nullptr) {
    definition->blend_shape_pose = std::make_shared<const wrinkle::BlendShapePose>(
        wrinkle::BlendShapePose::Create(*rig_, *character_.skeleton, shapes.pose_names(),
                                        maps_.shapes.AllNamesOf(character_.shapes)));
    rig::ShapeMatch face =
        maps_.shapes.MatchFace(shapes.source_names(), character_.shapes, character_.shape_rules,
                               /*is_solved=*/definition->joint_shapes != nullptr);
    definition->face_match = rig::Describe(face);
    definition->shape_program =
        std::make_shared<const wrinkle::ShapeProgram>(std::move(face.program));
    definition->head_turn = std::make_shared<const wrinkle::HeadTurn>(
        skeleton.num_joints() > 0
            ? wrinkle::HeadTurn()
            : wrinkle::HeadTurn::Create(*character_.skeleton, match.character.roles, blend_shapes));
  }
  definition->binding = std::make_shared<const wrinkle::RigBinding>(*std::move(binding));
  definition->skeleton = std::move(skeleton);
  definition->blend_shapes = std::move(blend_shapes);
  definition->shapes = std::move(shapes);
  Report(match, definition.get());
  definition->match = std::move(match);
  return std::shared_ptr<const StreamDefinition>(std::move(definition));
}

// Null if the stream's blend shapes move shapes, because two sources would add up, or if no joint
// does.
std::shared_ptr<const wrinkle::JointShapes> StreamDefinitions::MatchJointShapes(
    const wrinkle::Skeleton& skeleton, std::span<const std::string> blend_shapes,
    const rig::SkeletonMatch& match, const StreamDefinition& stream) const {
  if (character_.surface == nullptr ||
      !rig::MatchShapes(maps_.shapes, blend_shapes, character_.shapes).empty()) {
    return nullptr;
  }
  auto found = rig::MatchFaceJoints(
      {skeleton, match.stream.roles, match.turn(), stream.retarget->unmatched_source()},
      {*character_.skeleton, match.character.roles, *character_.surface, character_.shapes,
       character_.shape_rules},
      maps_.shapes);
  if (found.empty()) return nullptr;
  return std::make_shared<const wrinkle::JointShapes>(std::move(found));
}

// Once per definition, so that repeated offers do not flood the log. Sets the ignored joints.
void StreamDefinitions::Report(const rig::SkeletonMatch& match,
                               StreamDefinition* definition) const {
  LogMatch(match, *definition);
  LogFaults(*definition);
  JointUse use = FindJointUse(*definition, match, rig_joints_);
  if (!use.ignored.empty()) {
    spdlog::info("joints that neither the rig nor the character has are ignored: {}",
                 Join(use.ignored));
  }
  const wrinkle::RigBinding& binding = *definition->binding;
  const bool feeds_any =
      use.feeds_any || (binding.missing_joints().empty() && binding.missing_blend_shapes().empty());
  if (!feeds_any && definition->shapes.drivers().num_mapped() == 0 &&
      !wrinkle::ReadsAny(*rig_, definition->shapes.source_names())) {
    spdlog::warn(
        "the rig uses no joint or blend shape of the stream, so all weights stay at rest; check "
        "--rig");
  }
  if (character_.skeleton != nullptr && !use.draws_any && !DrawsShapes(*definition)) {
    spdlog::warn(
        "the stream and the character have no joint in common, so pictures show the rest pose; "
        "check --character");
  }
  definition->ignored_joints = std::move(use.ignored);
}

}  // namespace furrow::server
