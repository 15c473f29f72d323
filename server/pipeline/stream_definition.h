// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/status.h"
#include "rig/skeleton_match.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/rig/rig_joints.h"
#include "wrinkle/shapes/blend_shape_pose.h"
#include "wrinkle/skeleton/retarget.h"
#include "wrinkle/skeleton/skeleton.h"
#include "wrinkle/solver/solver.h"

namespace furrow::server {

// What a sender says of its stream before the first pose.
struct StreamOffer {
  std::vector<wrinkle::JointDesc> joints;  // in wire order; none: blend shapes alone
  std::vector<std::string> blend_shapes;
};

// A stream's skeleton bound to the daemon's rig, made once and shared by all its subjects.
struct StreamDefinition {
  wrinkle::Skeleton skeleton;
  std::vector<std::string> blend_shapes;
  std::vector<std::int16_t> joint_of_wire;  // wire index -> index in `skeleton`
  // (The rig's joint, the stream's), where a skeleton map knows them by other names.
  std::vector<std::pair<std::string, std::string>> aliases;
  std::shared_ptr<const wrinkle::RigBinding> binding;
  // What moves the character; null where nothing is drawn.
  std::shared_ptr<const wrinkle::Retarget> retarget;
  std::shared_ptr<const wrinkle::BlendShapePose> blend_shape_pose;
};

// Makes stream definitions and keeps the newest `capacity` of them by skeleton and names: a sender
// that restarts, or a second one like it, costs nothing.
class StreamDefinitions {
 public:
  // `character` (may be null: nothing is drawn) outlives this. `matcher` tells what the joints of
  // skeletons are that call them otherwise than the rig and the character.
  StreamDefinitions(std::shared_ptr<const wrinkle::Rig> rig, const wrinkle::Skeleton* character,
                    std::size_t capacity, character::SkeletonMatcher matcher = {})
      : rig_(std::move(rig)),
        character_(character),
        capacity_(capacity),
        matcher_(std::move(matcher)),
        rig_joints_(wrinkle::JointsOf(*rig_)) {}

  // Errors: those of Skeleton::Create and RigBinding::Create. Logged, once a definition: the
  // skeleton map that knows the stream and the roles it does not find; what the
  // rig misses in the stream; joints that neither the rig nor the character knows, which are
  // ignored; a stream that moves no weight, or not the picture, at all.
  // `may_make` is asked before one is made that is not there yet; where it refuses, the answer is
  // null.
  [[nodiscard]] Result<std::shared_ptr<const StreamDefinition>> Get(
      StreamOffer offer, const std::function<bool()>& may_make = [] { return true; });

  [[nodiscard]] const wrinkle::Rig& rig() const { return *rig_; }
  [[nodiscard]] const std::shared_ptr<const wrinkle::Rig>& shared_rig() const { return rig_; }
  // Another rig for what is made from now on.
  void SetRig(std::shared_ptr<const wrinkle::Rig> rig);
  // A stream that was made with another rig, with this one. Errors: as Get().
  [[nodiscard]] Result<std::shared_ptr<const StreamDefinition>> Remake(
      const StreamDefinition& stream);

 private:
  [[nodiscard]] Result<std::shared_ptr<const StreamDefinition>> FindOrMake(
      wrinkle::Skeleton skeleton, std::vector<std::string> blend_shapes,
      const std::function<bool()>& may_make);
  [[nodiscard]] Result<std::shared_ptr<const StreamDefinition>> Make(
      wrinkle::Skeleton skeleton, std::vector<std::string> blend_shapes);
  void Report(const StreamDefinition& stream, const character::SkeletonMatch& match) const;

  std::shared_ptr<const wrinkle::Rig> rig_;
  const wrinkle::Skeleton* character_;
  std::size_t capacity_;
  character::SkeletonMatcher matcher_;
  std::set<std::string> rig_joints_;                          // all that the rig reads
  std::list<std::shared_ptr<const StreamDefinition>> known_;  // most recently used first
};

}  // namespace furrow::server
