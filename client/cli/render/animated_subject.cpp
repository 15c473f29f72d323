// SPDX-License-Identifier: Apache-2.0
#include "client/cli/render/animated_subject.h"

#include <cstdio>

#include "base/status.h"
#include "client/cli/common/inputs.h"
#include "motion/clip/capture_time.h"

namespace furrow::cli {

Result<std::unique_ptr<AnimatedSubject>> AnimatedSubject::Create(
    const character::Character& character, std::shared_ptr<const motion::Clip> clip,
    const rig::SkeletonMatcher& matcher, const rig::ShapeMatcher& shapes, const std::string& file,
    bool reports) {
  auto self = std::make_unique<AnimatedSubject>();
  self->clip_ = std::move(clip);
  const motion::Clip& take = *self->clip_;
  const auto match = matcher.Match(take.skeleton, character.rig, &character.skeleton);
  if (reports && !file.empty()) PrintMatch(match);
  const rig::JointMovedShapes solved = MatchFaceJoints(shapes, take, match, &character);
  self->shapes_ = MatchBlendShapes(shapes, take, character.rig, solved);
  auto binding =
      wrinkle::RigBinding::Create(character.rig, take.skeleton, self->shapes_.driver_names(),
                                  match.Options(/*allow_missing=*/true));
  FURROW_RETURN_IF_ERROR(binding);
  if (reports) WarnAboutMissing(*binding, take);
  self->solver_ = std::make_unique<wrinkle::SubjectSolver>(
      std::make_shared<const wrinkle::RigBinding>(std::move(*binding)));
  self->retarget_ = rig::MakeRetarget(match, take.skeleton, character.skeleton);
  self->blend_shape_pose_ =
      wrinkle::BlendShapePose::Create(character.rig, character.skeleton, self->shapes_.pose_names(),
                                      shapes.AllNamesOf(character.shapes));
  rig::ShapeMatch face =
      shapes.MatchFace(self->shapes_.source_names(), character.shapes, character.shape_rules,
                       /*is_solved=*/solved.solver != nullptr);
  const std::string text = rig::Describe(face);
  if (reports && !text.empty()) std::fprintf(stderr, "furrow: face: %s\n", text.c_str());
  self->shape_program_ = std::move(face.program);
  // A recording with joints turns the head by them.
  if (take.skeleton.num_joints() == 0) {
    self->head_turn_ = wrinkle::HeadTurn::Create(character.skeleton, match.character.roles,
                                                 take.blend_shape_names);
  }
  // Pictures would all show the rest pose.
  if (self->shapes_.source_names().empty() &&
      self->retarget_.unmatched_source().size() == take.skeleton.joint_names().size()) {
    return Status(StatusCode::kNotFound, "the recording and the character have no joint in common",
                  file, "map the joints with --skeleton-map, or choose another --character");
  }
  self->drawn_.emplace(&character.skeleton);
  return self;
}

Status AnimatedSubject::Advance(int frame) {
  clip_->GetPose(frame, &pose_);
  shapes_.Extend(&pose_);
  const bool solved =
      solver_->Update(pose_, motion::CaptureStep(*clip_, frame)) == wrinkle::JobStatus::kOk &&
      drawn_->Run({retarget_, blend_shape_pose_, &shape_program_, &head_turn_}, pose_.joints,
                  pose_.blend_shapes) == wrinkle::JobStatus::kOk;
  if (!solved)
    return {StatusCode::kInternal, "frame " + std::to_string(frame) + " could not be solved"};
  return {};
}

render::PosedSubject AnimatedSubject::subject() const {
  return {.model = drawn_->model(),
          .shapes = drawn_->shapes(),
          .binding = &solver_->binding(),
          .wrinkle_weights = solver_->wrinkle_weights(),
          .filtered_values = solver_->filtered_values()};
}

}  // namespace furrow::cli
