// SPDX-License-Identifier: Apache-2.0
#include "bench/render/moving_scene.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include "bench/report/value_or_exit.h"

namespace furrow::bench {
namespace {

constexpr double kFrameSeconds = 1.0 / 60.0;
constexpr double kSecondsAhead = 0.37;  // time offset from one subject to the next
constexpr float kFovDegrees = 30.0f;
constexpr float kMargin = 1.05f;

std::shared_ptr<const wrinkle::RigBinding> Bind(const character::Character& character) {
  return std::make_shared<const wrinkle::RigBinding>(
      ValueOrExit(wrinkle::RigBinding::Create(character.rig, character.skeleton, {})));
}

render::Camera Facing(const Extent& extent, PictureSize size) {
  const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
  const float half_height = kMargin * std::max(extent.half_height, extent.half_width / aspect);
  render::Camera camera;
  camera.fov_y_degrees = kFovDegrees;
  camera.target = glm::vec3(0.0f);
  camera.position = {0.0f, 0.0f, half_height / std::tan(glm::radians(0.5f * kFovDegrees))};
  return camera;
}

}  // namespace

void MoveFace(double seconds, const wrinkle::Skeleton& skeleton, wrinkle::LocalPose* pose) {
  for (std::size_t joint = 1; joint < pose->joints.size(); ++joint) {
    const double phase = 2.0 * seconds + 0.8 * static_cast<double>(joint);
    pose->joints[joint].translation =
        skeleton.rest_pose()[joint].translation +
        glm::vec3(0.0f, 0.01f * static_cast<float>(std::sin(phase)), 0.0f);
  }
}

void MoveBody(double seconds, const wrinkle::Skeleton& skeleton, wrinkle::LocalPose* pose) {
  for (std::size_t joint = 1; joint < pose->joints.size(); ++joint) {
    const double angle = 0.6 * std::sin(2.0 * seconds + 0.5 * static_cast<double>(joint));
    pose->joints[joint].rotation =
        skeleton.rest_pose()[joint].rotation *
        glm::angleAxis(static_cast<float>(angle), glm::vec3(1.0f, 0.0f, 0.0f));
  }
}

MovingScene::MovingScene(const character::Character& character,
                         const std::vector<glm::mat4>& placements, const Extent& extent,
                         PictureSize size, Motion motion, const std::string& device)
    : skeleton_(character.skeleton),
      motion_(std::move(motion)),
      renderer_(ValueOrExit(render::Renderer::Create(character, {device}))) {
  const auto binding = Bind(character);
  for (const glm::mat4& placement : placements) {
    Subject& subject = subjects_.emplace_back(
        Subject{wrinkle::SubjectSolver(binding),
                {},
                std::vector<glm::mat4>(static_cast<std::size_t>(skeleton_.num_joints())),
                placement});
    subject.pose.SetRest(skeleton_);
  }
  request_.camera = Facing(extent, size);
  request_.width = size.width;
  request_.height = size.height;
}

render::PosedSubject MovingScene::Advance(std::size_t index) {
  Subject& subject = subjects_[index];
  motion_(kFrameSeconds * frame_ + kSecondsAhead * static_cast<double>(index), skeleton_,
          &subject.pose);
  const wrinkle::LocalToModelJob to_model{&skeleton_, subject.pose.joints, subject.model};
  if (to_model.Run() != wrinkle::JobStatus::kOk ||
      subject.solver.Update(subject.pose, kFrameSeconds) != wrinkle::JobStatus::kOk) {
    FailWith({StatusCode::kInternal, "cannot solve the pose of the benchmark", "scene"});
  }
  return {subject.model,
          {},
          &subject.solver.binding(),
          subject.solver.wrinkle_weights(),
          subject.solver.filtered_values(),
          subject.placement};
}

void MovingScene::Submit(const render::Settings& settings) {
  static_cast<render::PosedSubject&>(request_) = Advance(0);
  others_.clear();
  for (std::size_t i = 1; i < subjects_.size(); ++i) others_.push_back(Advance(i));
  ++frame_;
  request_.others = others_;
  request_.settings = settings;
  if (Status status = renderer_->Submit(request_); !status.ok()) FailWith(status);
}

Sample MovingScene::SecondsPerFrame(const render::Settings& settings, int frames) {
  const auto draw = [&] {
    for (int i = 0; i < frames; ++i) {
      if (renderer_->in_flight() == 2) (void)ValueOrExit(renderer_->Poll(true));
      Submit(settings);
    }
    while (renderer_->in_flight() > 0) (void)ValueOrExit(renderer_->Poll(true));
  };
  return Measure(draw, frames);
}

std::vector<render::PassTime> MovingScene::TimePasses(const render::Settings& settings) {
  render::PassTimer timer;
  renderer_->SetObserver(&timer);
  Submit(settings);
  (void)ValueOrExit(renderer_->Poll(true));
  renderer_->SetObserver(nullptr);
  return timer.Take();
}

}  // namespace furrow::bench
