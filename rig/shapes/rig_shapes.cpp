// SPDX-License-Identifier: Apache-2.0
#include "rig/shapes/rig_shapes.h"

#include <algorithm>

#include "base/ascii.h"
#include "rig/shapes/arkit_shapes.h"
#include "wrinkle/rig/rig_blend_shapes.h"

namespace furrow::rig {
namespace {

// Adds a name that the list does not have in any case.
void AddTarget(const std::string& name, std::vector<std::string>* targets) {
  const auto is_same = [&](const std::string& known) { return EqualsIgnoreCase(known, name); };
  if (std::ranges::none_of(*targets, is_same)) targets->push_back(name);
}

// Reference poses are named freely ("jaw_open" is a pose of the default rig), so only ARKit's exact
// names count as blend shapes, and names that the stream itself has.
std::vector<std::string> ShapesOfPoses(const wrinkle::Rig& rig,
                                       std::span<const std::string> stream) {
  std::vector<std::string> targets;
  for (const wrinkle::ReferencePose& pose : rig.reference_poses) {
    const bool in_stream = std::ranges::any_of(
        stream, [&](const std::string& name) { return EqualsIgnoreCase(name, pose.name); });
    if (in_stream || FindArkitShape(pose.name) >= 0) AddTarget(pose.name, &targets);
  }
  return targets;
}

}  // namespace

std::vector<std::string> ArkitAndRigShapes(const wrinkle::Rig& rig) {
  std::vector<std::string> names(ArkitShapes().begin(), ArkitShapes().end());
  for (const std::string& name : wrinkle::BlendShapesOf(rig)) AddTarget(name, &names);
  return names;
}

RigShapes::RigShapes(const ShapeMatcher& matcher, std::span<const std::string> stream,
                     const wrinkle::Rig& rig, const JointMovedShapes& moved)
    : num_of_stream_(stream.size()), driver_names_(stream.begin(), stream.end()) {
  if (moved.solver != nullptr && !moved.solver->empty()) {
    joint_shapes_ = moved.solver;
    driver_names_.insert(driver_names_.end(), moved.names.begin(), moved.names.end());
  }
  num_of_sources_ = driver_names_.size();
  pose_names_ = driver_names_;
  // A body tracker's stream has nothing to translate.
  if (driver_names_.empty()) return;
  const std::vector<std::string> sources = driver_names_;
  const std::vector<std::string> drivers = wrinkle::BlendShapesOf(rig);
  drivers_ = matcher.Match(sources, drivers);
  Append(drivers_, drivers, &driver_names_, &pose_names_);
  num_of_drivers_ = size() - num_of_sources_;
  const std::vector<std::string> poses = ShapesOfPoses(rig, sources);
  poses_ = matcher.Match(sources, poses);
  Append(poses_, poses, &pose_names_, &driver_names_);
}

// Targets that the stream has by name keep the stream's own coefficient.
void RigShapes::Append(const ShapeMatch& match, std::span<const std::string> targets,
                       std::vector<std::string>* names, std::vector<std::string>* other) {
  if (match.num_mapped() == 0) return;
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const bool is_mapped =
        match.by[t] != ShapeMatch::By::kNothing && match.by[t] != ShapeMatch::By::kSameName;
    names->push_back(is_mapped ? targets[t] : std::string());
    other->emplace_back();
  }
}

void RigShapes::Extend(wrinkle::LocalPose* pose) const {
  pose->blend_shapes.resize(size(), 0.0f);
  if (size() == num_of_stream_) return;
  const std::span<float> coefficients(pose->blend_shapes);
  const auto sources = coefficients.first(num_of_sources_);
  const auto extension = coefficients.subspan(num_of_sources_);
  // A status other than Ok means that the solver refuses the pose as well.
  if (joint_shapes_ != nullptr) {
    (void)joint_shapes_->Run(pose->joints, sources.subspan(num_of_stream_));
  }
  if (num_of_drivers_ > 0) (void)drivers_.program.Run(sources, extension.first(num_of_drivers_));
  const auto poses = extension.subspan(num_of_drivers_);
  if (!poses.empty()) (void)poses_.program.Run(sources, poses);
}

std::string RigShapes::Description() const {
  // The drivers make the weights; a rig without them is described by its poses.
  const std::string text = Describe(drivers_);
  return text.empty() ? Describe(poses_) : text;
}

}  // namespace furrow::rig
