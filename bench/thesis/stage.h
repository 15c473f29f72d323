// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/report/interleave.h"
#include "bench/thesis/subjects.h"
#include "render/gl/pass_timer.h"
#include "render/renderer.h"
#include "wrinkle/solver/solver.h"

namespace furrow::bench {

// Puts a subject into its pose at a time in seconds: local transforms, from the rest pose.
using Motion = std::function<void(double seconds, const wrinkle::Skeleton&, wrinkle::LocalPose*)>;

// Facial joints that swing between the poses stretch and squash, each at its own phase, so that
// both maps are at work in every frame.
void MoveFace(double seconds, const wrinkle::Skeleton& skeleton, wrinkle::LocalPose* pose);
// Every joint of the body sways by up to 34 degrees.
void MoveBody(double seconds, const wrinkle::Skeleton& skeleton, wrinkle::LocalPose* pose);

struct PictureSize {
  int width = 1280;
  int height = 800;
};

// A moving character, once or many times, in front of a camera that it just fills. Every subject
// has its own solver and is ahead of the one before, so that no two make the same face.
class Stage {
 public:
  // `placements`: one a subject, at least one. Aborts with the error on stderr where there is no
  // OpenGL: a benchmark has nothing to fall back on.
  Stage(const character::Character& character, const std::vector<glm::mat4>& placements,
        const Extent& extent, PictureSize size, Motion motion, const std::string& device);

  // Seconds a frame, pose to pixels, over `frames` frames of 1/60 s each: solve, draw and read
  // back, two frames in flight as in the daemon.
  [[nodiscard]] Sample SecondsPerFrame(const render::Settings& settings, int frames);
  // Times of the passes of one frame, drawn alone.
  [[nodiscard]] std::vector<render::PassTime> TimePasses(const render::Settings& settings);

  [[nodiscard]] std::string device() const { return renderer_->description(); }

 private:
  struct Subject {
    wrinkle::SubjectSolver solver;
    wrinkle::LocalPose pose;
    std::vector<glm::mat4> model;
    glm::mat4 placement;
  };
  // Moves a subject to the frame's time; what to draw points into it.
  [[nodiscard]] render::PosedSubject Advance(std::size_t subject);
  void Submit(const render::Settings& settings);

  wrinkle::Skeleton skeleton_;
  Motion motion_;
  std::unique_ptr<render::Renderer> renderer_;
  std::vector<Subject> subjects_;
  std::vector<render::PosedSubject> others_;
  render::FrameRequest request_;
  int frame_ = 0;
};

}  // namespace furrow::bench
