// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "motion/clip/clip.h"
#include "render/renderer.h"
#include "rig/shapes/rig_shapes.h"
#include "rig/skeleton_match.h"
#include "wrinkle/shapes/character_pose.h"
#include "wrinkle/solver/solver.h"

namespace furrow::cli {

// A recording applied to a character: solves each frame as `furrow solve` does, and poses the
// character for drawing.
class AnimatedSubject {
 public:
  // `character` must outlive this object. `file` names the clip in errors. Prints which skeleton
  // map the recording follows, unless `file` is empty (a pose of the character), and warnings about
  // joints and blend shapes that the recording lacks. `reports`: false for a further subject of the
  // same recording. Errors: those of wrinkle::RigBinding;
  // kNotFound (the recording and the character have no joint in common).
  [[nodiscard]] static Result<std::unique_ptr<AnimatedSubject>> Create(
      const character::Character& character, std::shared_ptr<const motion::Clip> clip,
      const rig::SkeletonMatcher& matcher, const rig::ShapeMatcher& shapes, const std::string& file,
      bool reports = true);

  [[nodiscard]] int num_frames() const { return clip_->num_frames(); }
  // Solves frame `frame` in [0, num_frames). The filter of the weights depends on earlier frames,
  // so call it for consecutive frames; after the last frame continue with 0. Errors: kInternal.
  [[nodiscard]] Status Advance(int frame);
  // The last solved frame. Its spans point into this object and are valid until the next Advance().
  [[nodiscard]] render::PosedSubject subject() const;

 private:
  std::shared_ptr<const motion::Clip> clip_;
  wrinkle::Retarget retarget_;
  rig::RigShapes shapes_;
  wrinkle::BlendShapePose blend_shape_pose_;
  wrinkle::ShapeProgram shape_program_;
  wrinkle::HeadTurn head_turn_;
  std::unique_ptr<wrinkle::SubjectSolver> solver_;
  wrinkle::LocalPose pose_;
  std::optional<wrinkle::CharacterPose> drawn_;
};

}  // namespace furrow::cli
