// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "motion/clip/clip.h"
#include "tests/temporary_folder.h"
#include "wrinkle/skeleton/pose.h"

// Helpers for the tests of motion/.
namespace furrow::motion {

inline std::vector<glm::mat4> ModelMatrices(const Clip& clip, int frame) {
  wrinkle::LocalPose pose;
  clip.GetPose(frame, &pose);
  std::vector<glm::mat4> model(pose.joints.size());
  wrinkle::LocalToModelJob job{&clip.skeleton, pose.joints, model};
  return job.Run() == wrinkle::JobStatus::kOk ? model : std::vector<glm::mat4>();
}

inline glm::vec3 ModelPosition(const Clip& clip, int frame, std::string_view joint) {
  const int index = clip.skeleton.Find(joint);
  return glm::vec3(ModelMatrices(clip, frame).at(static_cast<std::size_t>(index))[3]);
}

// The largest distance between joints of the same name in two clips, over all frames of `a`.
inline float WorstDistance(const Clip& a, const Clip& b) {
  float worst = 0.0f;
  for (int frame = 0; frame < a.num_frames(); ++frame) {
    const std::vector<glm::mat4> in_a = ModelMatrices(a, frame);
    const std::vector<glm::mat4> in_b = ModelMatrices(b, frame);
    for (std::size_t j = 0; j < in_a.size(); ++j) {
      const int other = b.skeleton.Find(a.skeleton.joint_names()[j]);
      const glm::vec3 p(in_a[j][3]);
      const glm::vec3 q(in_b.at(static_cast<std::size_t>(other))[3]);
      worst = std::max(worst, glm::length(p - q));
    }
  }
  return worst;
}

inline std::filesystem::path SharedFile(const std::string& name) {
  return std::filesystem::path(FURROW_SHARED_DATA) / name;
}

inline std::string ReadAll(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace furrow::motion
