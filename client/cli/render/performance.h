// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "motion/clip/clip.h"
#include "render/renderer.h"
#include "rig/skeleton_match.h"
#include "wrinkle/shapes/character_pose.h"
#include "wrinkle/solver/solver.h"

namespace furrow::cli {

// A recording on a character: solved frame by frame, as `furrow solve` does, and posed for drawing.
class Performance {
 public:
  // `character` outlives it. `file` names the clip in errors. Prints what the recording lacks.
  // Errors: of wrinkle::RigBinding, and kNotFound (no joint of it is one of the character's).
  [[nodiscard]] static Result<std::unique_ptr<Performance>> Create(
      const character::Character& character, std::shared_ptr<const motion::Clip> clip,
      const character::SkeletonMatcher& matcher, const std::string& file);

  [[nodiscard]] int num_frames() const { return clip_->num_frames(); }
  // Solves frame `frame` in [0, num_frames), the one after the last or the first of another round:
  // the filter remembers.
  [[nodiscard]] Status Advance(int frame);
  // The last frame solved; spans point into this object.
  [[nodiscard]] render::PosedSubject subject() const;

 private:
  std::shared_ptr<const motion::Clip> clip_;
  wrinkle::Retarget retarget_;
  wrinkle::BlendShapePose blend_shape_pose_;
  std::unique_ptr<wrinkle::SubjectSolver> solver_;
  wrinkle::LocalPose pose_;
  std::optional<wrinkle::CharacterPose> drawn_;
};

}  // namespace furrow::cli
