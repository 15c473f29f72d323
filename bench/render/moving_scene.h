// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/report/interleave.h"
#include "character/character.h"
#include "render/gl/pass_timer.h"
#include "render/renderer.h"
#include "wrinkle/solver/solver.h"

namespace furrow::bench {

// Sets a subject's pose at a time in seconds: local transforms, starting from the rest pose.
using Motion = std::function<void(double seconds, const wrinkle::Skeleton&, wrinkle::LocalPose*)>;

// Swings the facial joints between the poses stretch and squash, each at its own phase, so that
// every frame uses both maps.
void MoveFace(double seconds, const wrinkle::Skeleton& skeleton, wrinkle::LocalPose* pose);
// Bends every joint of the body by up to 34 degrees.
void MoveBody(double seconds, const wrinkle::Skeleton& skeleton, wrinkle::LocalPose* pose);

struct PictureSize {
  int width = 1280;
  int height = 800;
};

// Half the width and height of the visible area, in metres.
struct Extent {
  float half_width = 0.0f;
  float half_height = 0.0f;
};

// One or more instances of a moving character that just fill the view of the camera. Every subject
// has its own solver and a time offset, so no two subjects have the same pose.
class MovingScene {
 public:
  // `placements`: one per subject, at least one. Exits the program with an error on stderr if
  // OpenGL is unavailable.
  MovingScene(const character::Character& character, const std::vector<glm::mat4>& placements,
              const Extent& extent, PictureSize size, Motion motion, const std::string& device);

  // Seconds per frame from pose to pixels (solve, draw, read back), over `frames` frames of 1/60 s
  // each. Two frames are in flight, as in the daemon.
  [[nodiscard]] Sample SecondsPerFrame(const render::Settings& settings, int frames);
  // Times of the passes of a single frame, with nothing else in flight.
  [[nodiscard]] std::vector<render::PassTime> TimePasses(const render::Settings& settings);

  [[nodiscard]] std::string device() const { return renderer_->description(); }

 private:
  struct Subject {
    wrinkle::SubjectSolver solver;
    wrinkle::LocalPose pose;
    std::vector<glm::mat4> model;
    glm::mat4 placement;
  };
  // Moves a subject to the time of the frame. The result points into the subject.
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
