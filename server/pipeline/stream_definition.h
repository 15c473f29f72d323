// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/status.h"
#include "rig/shapes/rig_shapes.h"
#include "rig/skeleton_match.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/rig/rig_joints.h"
#include "wrinkle/shapes/blend_shape_pose.h"
#include "wrinkle/shapes/head_turn.h"
#include "wrinkle/shapes/joint_shapes.h"
#include "wrinkle/shapes/shape_program.h"
#include "wrinkle/skeleton/retarget.h"
#include "wrinkle/skeleton/skeleton.h"
#include "wrinkle/solver/solver.h"

namespace furrow::server {

// What a sender declares about its stream before the first pose.
struct StreamOffer {
  std::vector<wrinkle::JointDesc> joints;  // in wire order; empty: blend shapes only
  std::vector<std::string> blend_shapes;
};

// A stream's skeleton bound to the daemon's rig. Equal streams share one definition.
struct StreamDefinition {
  wrinkle::Skeleton skeleton;
  std::vector<std::string> blend_shapes;
  // What the rig reads besides the stream's own blend shapes, which come first in every pose.
  rig::RigShapes shapes;
  std::vector<std::int16_t> joint_of_wire;  // wire index -> index in `skeleton`
  rig::SkeletonMatch match;                 // how a skeleton map has matched the rig's joints
  std::shared_ptr<const wrinkle::RigBinding> binding;
  std::vector<std::string> ignored_joints;  // that move neither weights nor pictures
  // These move the character by the stream's poses; null without a character.
  std::shared_ptr<const wrinkle::Retarget> retarget;
  std::shared_ptr<const wrinkle::BlendShapePose> blend_shape_pose;
  std::shared_ptr<const wrinkle::ShapeProgram> shape_program;
  std::string face_match;  // how shape_program was found (rig::Describe()); empty: by equal names
  std::shared_ptr<const wrinkle::HeadTurn> head_turn;  // empty if the stream has joints
  // Moves the character's shapes by the stream's joints; null if the stream's blend shapes do.
  std::shared_ptr<const wrinkle::JointShapes> joint_shapes;
};

// The character that streams move; all of it outlives those who use it.
struct StreamCharacter {
  const wrinkle::Skeleton* skeleton = nullptr;  // null: nothing is drawn, and no shapes move
  std::span<const std::string> shapes;          // names
  std::span<const wrinkle::ShapeRule> shape_rules;
  const wrinkle::MovedSurface* surface = nullptr;  // null: joints move no shapes
};

// Finds the joints and the blend shapes of streams that have other names than those of the rig and
// of the character.
struct StreamMaps {
  rig::SkeletonMatcher skeletons;
  rig::ShapeMatcher shapes;
};

// Creates stream definitions and keeps the `capacity` most recently used ones, so that a sender
// that restarts, or several senders with equal skeletons, share one.
class StreamDefinitions {
 public:
  StreamDefinitions(std::shared_ptr<const wrinkle::Rig> rig, const StreamCharacter& character,
                    std::size_t capacity, StreamMaps maps = {})
      : rig_(std::move(rig)),
        character_(character),
        capacity_(capacity),
        maps_(std::move(maps)),
        rig_joints_(wrinkle::JointsOf(*rig_)) {}

  // Returns the definition of a stream, creating it if needed. `may_make` is called before a new
  // one is created; if it returns false, the result is null. Errors: those of Skeleton::Create()
  // and RigBinding::Create().
  //
  // Logs once per definition: the matching skeleton map and shape map, joints and blend shapes that
  // the rig needs and the stream lacks, joints that are ignored, and streams that move no weight or
  // no picture.
  [[nodiscard]] Result<std::shared_ptr<const StreamDefinition>> Get(
      StreamOffer offer, const std::function<bool()>& may_make = [] { return true; });

  [[nodiscard]] const wrinkle::Rig& rig() const { return *rig_; }
  [[nodiscard]] const std::shared_ptr<const wrinkle::Rig>& shared_rig() const { return rig_; }
  // Uses another rig for definitions created from now on.
  void SetRig(std::shared_ptr<const wrinkle::Rig> rig);
  // Uses other maps for definitions created from now on. Returns the ones before.
  [[nodiscard]] StreamMaps SetMaps(StreamMaps maps);
  // Limits the number of definitions that are kept for reuse.
  void SetCapacity(std::size_t capacity);
  // Binds the stream of an old definition to the current rig. Errors: those of Get().
  [[nodiscard]] Result<std::shared_ptr<const StreamDefinition>> Rebind(
      const StreamDefinition& stream);

 private:
  [[nodiscard]] Result<std::shared_ptr<const StreamDefinition>> FindOrMake(
      wrinkle::Skeleton skeleton, std::vector<std::string> blend_shapes,
      const std::function<bool()>& may_make);
  [[nodiscard]] Result<std::shared_ptr<const StreamDefinition>> Make(
      wrinkle::Skeleton skeleton, std::vector<std::string> blend_shapes);
  [[nodiscard]] std::shared_ptr<const wrinkle::JointShapes> MatchJointShapes(
      const wrinkle::Skeleton& skeleton, std::span<const std::string> blend_shapes,
      const rig::SkeletonMatch& match, const StreamDefinition& stream) const;
  void Report(const rig::SkeletonMatch& match, StreamDefinition* stream) const;

  std::shared_ptr<const wrinkle::Rig> rig_;
  StreamCharacter character_;
  std::size_t capacity_;
  StreamMaps maps_;
  std::set<std::string> rig_joints_;                          // all joints that the rig reads
  std::list<std::shared_ptr<const StreamDefinition>> known_;  // most recently used first
};

}  // namespace furrow::server
