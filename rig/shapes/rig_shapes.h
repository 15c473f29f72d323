// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "rig/shapes/shape_match.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/shapes/joint_shapes.h"
#include "wrinkle/skeleton/pose.h"

namespace furrow::rig {

// The shapes of a character that the joints of a stream move; see MatchFaceJoints().
struct JointMovedShapes {
  std::shared_ptr<const wrinkle::JointShapes> solver;  // null: joints move no shapes
  std::span<const std::string> names;                  // all of the character's shapes
};

// ARKit's names, then those that the rig's drivers read under other names.
[[nodiscard]] std::vector<std::string> ArkitAndRigShapes(const wrinkle::Rig& rig);

// The blend shapes of a stream, extended by what else a rig reads: the character's shapes that the
// stream's joints move, then the blend shapes that the stream sends by other names or not at all.
// The extension follows the stream's own coefficients, which stay as they are, so a stream that has
// all names of the rig gives the same weights with and without it.
class RigShapes {
 public:
  RigShapes() = default;  // a stream without blend shapes, and no extension
  // Rigs read blend shapes by blend-shape drivers and, to move joints, by reference poses with the
  // name of a blend shape (wrinkle::BlendShapePose).
  RigShapes(const ShapeMatcher& matcher, std::span<const std::string> stream,
            const wrinkle::Rig& rig, const JointMovedShapes& moved = {});

  // The stream's names, then those of the shapes that its joints move.
  [[nodiscard]] std::span<const std::string> source_names() const {
    return driver_names().first(num_of_sources_);
  }
  // For RigBinding::Create(): source_names(), then those of the rest of the extension; "" if it is
  // not for drivers.
  [[nodiscard]] std::span<const std::string> driver_names() const { return driver_names_; }
  // For BlendShapePose::Create(): as driver_names(), with the names of reference poses.
  [[nodiscard]] std::span<const std::string> pose_names() const { return pose_names_; }
  // The number of coefficients of a pose, the stream's and the extension.
  [[nodiscard]] std::size_t size() const { return driver_names_.size(); }

  // Computes the extension of a pose of the stream, whose blend shapes grow to size(). Joints and
  // coefficients that are not finite leave the extension unchanged; the solver refuses them. Does
  // not allocate if the pose has size() blend shapes.
  void Extend(wrinkle::LocalPose* pose) const;

  // How the blend shapes of the rig's drivers, and its reference poses, are found.
  [[nodiscard]] const ShapeMatch& drivers() const { return drivers_; }
  [[nodiscard]] const ShapeMatch& poses() const { return poses_; }
  // One line for a log (Describe()); empty if no map is used.
  [[nodiscard]] std::string Description() const;

 private:
  void Append(const ShapeMatch& match, std::span<const std::string> targets,
              std::vector<std::string>* names, std::vector<std::string>* other);

  std::size_t num_of_stream_ = 0;
  std::size_t num_of_sources_ = 0;
  std::size_t num_of_drivers_ = 0;  // size of the extension's first part
  std::vector<std::string> driver_names_;
  std::vector<std::string> pose_names_;
  ShapeMatch drivers_;
  ShapeMatch poses_;
  std::shared_ptr<const wrinkle::JointShapes> joint_shapes_;  // null: joints move no shapes
};

}  // namespace furrow::rig
