// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/subject_pipeline.h"

#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include "server/pipeline/neutral_part.h"
#include "wrinkle/shapes/head_turn.h"

namespace furrow::server {

SubjectPipeline::SubjectPipeline(std::shared_ptr<const StreamDefinition> stream)
    : stream_(std::move(stream)), solver_(stream_->binding) {
  pose_.SetRest(stream_->skeleton);
  pose_.blend_shapes.assign(stream_->shapes.size(), 0.0f);
}

wrinkle::JobStatus SubjectPipeline::Solve(std::uint32_t sequence, std::int64_t capture_time_us) {
  // The same two steps as in a batch, so that one pose alone gives the same weights.
  const wrinkle::BatchUpdate update = Prepare(sequence, capture_time_us);
  return Finish(solver_.Update(*update.pose, update.dt));
}

wrinkle::BatchUpdate SubjectPipeline::Prepare(std::uint32_t sequence,
                                              std::int64_t capture_time_us) {
  double dt = 0.0;
  if (has_pose_ && capture_time_us >= capture_time_us_) {
    dt = static_cast<double>(capture_time_us - capture_time_us_) * 1e-6;
  } else if (has_pose_) {
    // Time went back: a looping recording or a new clock. What the filter remembers is not the past
    // of this pose.
    solver_.Reset();
  }
  // What the rig reads besides the stream's own blend shapes.
  stream_->shapes.Extend(&pose_);
  // Writes corrected_, which solved_pose() then returns.
  if (neutral_pose_) SubtractNeutral();
  next_sequence_ = sequence;
  next_capture_time_us_ = capture_time_us;
  waits_ = true;
  return {.solver = &solver_, .pose = &solved_pose(), .dt = dt};
}

wrinkle::JobStatus SubjectPipeline::Finish(wrinkle::JobStatus status) {
  // A refused pose leaves sequence, time and weights at those of the last good one.
  waits_ = false;
  if (status != wrinkle::JobStatus::kOk) return status;
  sequence_ = next_sequence_;
  capture_time_us_ = next_capture_time_us_;
  has_pose_ = true;
  return status;
}

// Applies each joint's difference from the neutral pose to the rest pose.
void SubjectPipeline::SubtractNeutral() {
  const auto rest = stream_->skeleton.rest_pose();
  for (std::size_t joint = 0; joint < pose_.joints.size(); ++joint) {
    const wrinkle::Transform& now = pose_.joints[joint];
    const wrinkle::Transform& neutral = neutral_pose_->joints[joint];
    wrinkle::Transform& out = corrected_.joints[joint];
    // The turn from the neutral to the present pose, in the parent's space, applied to the rest
    // pose.
    out.rotation =
        glm::normalize(now.rotation * glm::inverse(neutral.rotation) * rest[joint].rotation);
    out.translation = rest[joint].translation + (now.translation - neutral.translation);
    // A neutral pose corrects rotations and translations only.
    out.scale = now.scale;
  }
  for (std::size_t shape = 0; shape < pose_.blend_shapes.size(); ++shape) {
    corrected_.blend_shapes[shape] = pose_.blend_shapes[shape] - neutral_pose_->blend_shapes[shape];
  }
}

bool SubjectPipeline::SetNeutral(std::optional<wrinkle::LocalPose> neutral) {
  if (neutral && (neutral->joints.size() != pose_.joints.size() ||
                  neutral->blend_shapes.size() != pose_.blend_shapes.size())) {
    return false;
  }
  neutral_pose_ = std::move(neutral);
  PrepareNeutral();
  SolveAgain(solver_.seconds_without_pose());
  return true;
}

void SubjectPipeline::PrepareNeutral() {
  if (!neutral_pose_) return;
  corrected_ = pose_;  // sizes it; SubtractNeutral() overwrites the values
  face_joints_ = FaceJoints(*stream_);
  above_neutral_.clear();
  const std::span<const std::string> names = stream_->shapes.driver_names();
  for (std::size_t i = 0; i < neutral_pose_->blend_shapes.size(); ++i) {
    const bool is_angle = i < names.size() && wrinkle::IsTrackerAngle(names[i]);
    const float most = is_angle ? 0.0f : 0.5f;
    above_neutral_.push_back(1.0f /
                             (1.0f - std::clamp(neutral_pose_->blend_shapes[i], 0.0f, most)));
  }
}

void SubjectPipeline::SetStream(std::shared_ptr<const StreamDefinition> stream) {
  stream_ = std::move(stream);
  // Another rig may read other blend shapes. The stream's own come first and stay.
  stream_->shapes.Extend(&pose_);
  if (neutral_pose_) {
    stream_->shapes.Extend(&*neutral_pose_);
  }
  PrepareNeutral();
  // The level starts at all drivers again; Subscribers::OnSubjectReady() lowers it.
  const double decayed = solver_.seconds_without_pose();
  solver_ = wrinkle::SubjectSolver(stream_->binding);
  SolveAgain(decayed);
}

// The statuses are not needed: a pose that was refused before is refused again. What has decayed
// must not come back: the folds of absent performers would flash.
void SubjectPipeline::SolveAgain(double decayed) {
  solver_.Reset();
  if (!has_pose_) return;
  (void)Solve(sequence_, capture_time_us_);
  (void)solver_.Decay(decayed);
}

void SubjectPipeline::SetLevel(std::size_t num_drivers) {
  if (num_drivers == level()) return;
  // The status is not needed: a pose that was rejected before is rejected again.
  (void)solver_.SetLevel(solved_pose(), num_drivers);
}

SubjectPipeline::Memory SubjectPipeline::memory() const {
  return {.sequence = sequence_,
          .capture_time_us = capture_time_us_,
          .level = level(),
          .solver = solver_.Memory()};
}

bool SubjectPipeline::Resume(const wrinkle::LocalPose& pose, const Memory& memory) {
  if (pose.joints.size() != pose_.joints.size() ||
      pose.blend_shapes.size() != pose_.blend_shapes.size() || !solver_.Remember(memory.solver)) {
    return false;
  }
  pose_ = pose;
  stream_->shapes.Extend(&pose_);
  if (neutral_pose_) SubtractNeutral();
  solver_.set_num_drivers(memory.level);
  sequence_ = memory.sequence;
  capture_time_us_ = memory.capture_time_us;
  has_pose_ = true;
  return true;
}

wrinkle::JobStatus SubjectPipeline::Decay(double dt) { return solver_.Decay(dt); }

bool SubjectPipeline::neutral() const {
  // Half a step of an 8-bit weight: smaller values are neither visible nor sent. Weights do not
  // count, because curves and angles may show folds at rest.
  constexpr float kNothing = 0.5f / 255.0f;
  return std::ranges::all_of(solver_.filtered_values(),
                             [](float value) { return value < kNothing; });
}

void SubjectPipeline::ShowFaceFromNeutral(Snapshot* snapshot) const {
  for (std::size_t j = 0; j < face_joints_.size(); ++j) {
    if (face_joints_[j]) snapshot->joints[j] = corrected_.joints[j];
  }
  for (std::size_t i = 0; i < snapshot->blend_shapes.size(); ++i) {
    float& shape = snapshot->blend_shapes[i];
    if (shape > 0.0f) shape *= above_neutral_[i];
  }
}

std::shared_ptr<const Snapshot> SubjectPipeline::TakeSnapshot(std::int64_t age_us,
                                                              std::int64_t received_us) const {
  const auto weights = solver_.wrinkle_weights();
  const auto filtered = solver_.filtered_values();
  // A copy, not a view: the render thread reads it while this thread solves the next pose. What
  // does not change per pose is shared.
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->sequence = sequence_;
  snapshot->capture_time_us = capture_time_us_;
  snapshot->age_us = age_us;
  snapshot->received_us = received_us;
  snapshot->binding = stream_->binding;
  snapshot->retarget = stream_->retarget;
  snapshot->blend_shape_pose = stream_->blend_shape_pose;
  snapshot->shape_program = stream_->shape_program;
  snapshot->head_turn = stream_->head_turn;
  snapshot->joints = pose_.joints;
  snapshot->blend_shapes = solved_pose().blend_shapes;
  if (neutral_pose_) ShowFaceFromNeutral(snapshot.get());
  snapshot->wrinkle_weights.assign(weights.begin(), weights.end());
  snapshot->filtered_values.assign(filtered.begin(), filtered.end());
  return snapshot;
}

}  // namespace furrow::server
