// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/recordings/recording_bvh.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

namespace furrow::authoring {
namespace {

constexpr float kDegreesPerRadian = 57.29577951308232f;

std::string Numbers(const glm::vec3& v) {
  char text[96];
  // Avoids "-0.000000", so that equal poses give equal text.
  const auto tidy = [](float x) { return std::abs(x) < 5e-7f ? 0.0 : static_cast<double>(x); };
  std::snprintf(text, sizeof text, "%.6f %.6f %.6f", tidy(v.x), tidy(v.y), tidy(v.z));
  return text;
}

// The angles of R = Rz * Ry * Rx as (z, y, x), degrees.
glm::vec3 ZyxDegrees(const glm::quat& rotation) {
  const glm::mat3 m = glm::mat3_cast(rotation);  // m[column][row]
  const float y = std::asin(std::clamp(-m[0][2], -1.0f, 1.0f));
  return glm::vec3(std::atan2(m[0][1], m[0][0]), y, std::atan2(m[1][2], m[2][2])) *
         kDegreesPerRadian;
}

bool Translates(const Recording& recording, const wrinkle::Skeleton& skeleton, int joint) {
  if (skeleton.joint_parents()[joint] == wrinkle::kNoJoint) return true;
  const glm::vec3 rest = skeleton.rest_pose()[joint].translation;
  return std::any_of(recording.frames.begin(), recording.frames.end(),
                     [&](const auto& frame) { return frame[joint].translation != rest; });
}

// Writes joints depth first, which is the order of BVH channels, and records that order.
class Hierarchy {
 public:
  Hierarchy(const Recording& recording, const wrinkle::Skeleton& skeleton)
      : recording_(recording), skeleton_(skeleton) {}

  void Write(int joint, int depth) {
    const bool root = skeleton_.joint_parents()[joint] == wrinkle::kNoJoint;
    const std::string indent(static_cast<std::size_t>(depth) * 2, ' ');
    const bool moves = Translates(recording_, skeleton_, joint);
    order_.push_back({joint, moves});
    text_ += indent + (root ? "ROOT " : "JOINT ") + skeleton_.joint_names()[joint] + "\n";
    text_ += indent + "{\n";
    text_ += indent + "  OFFSET " + Numbers(skeleton_.rest_pose()[joint].translation) + "\n";
    text_ += indent + (moves ? "  CHANNELS 6 Xposition Yposition Zposition" : "  CHANNELS 3") +
             " Zrotation Yrotation Xrotation\n";
    bool leaf = true;
    for (int child = 0; child < skeleton_.num_joints(); ++child) {
      if (skeleton_.joint_parents()[child] != joint) continue;
      leaf = false;
      Write(child, depth + 1);
    }
    if (leaf) {
      text_ += indent + "  End Site\n" + indent + "  {\n" + indent + "    OFFSET " +
               Numbers(skeleton_.tails()[joint]) + "\n" + indent + "  }\n";
    }
    text_ += indent + "}\n";
  }

  struct Entry {
    int joint;
    bool moves;
  };
  [[nodiscard]] const std::vector<Entry>& order() const { return order_; }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  const Recording& recording_;
  const wrinkle::Skeleton& skeleton_;
  std::vector<Entry> order_;
  std::string text_;
};

}  // namespace

std::string RecordingToBvh(const Recording& recording, const wrinkle::Skeleton& skeleton) {
  Hierarchy hierarchy(recording, skeleton);
  for (int joint = 0; joint < skeleton.num_joints(); ++joint) {
    if (skeleton.joint_parents()[joint] == wrinkle::kNoJoint) hierarchy.Write(joint, 0);
  }
  char header[96];
  std::snprintf(header, sizeof header, "MOTION\nFrames: %zu\nFrame Time: %.8f\n",
                recording.frames.size(), 1.0 / kFramesPerSecond);
  std::string text = "HIERARCHY\n" + hierarchy.text() + header;
  for (const auto& frame : recording.frames) {
    std::string line;
    for (const auto& [joint, moves] : hierarchy.order()) {
      if (moves) line += (line.empty() ? "" : " ") + Numbers(frame[joint].translation);
      line += (line.empty() ? "" : " ") + Numbers(ZyxDegrees(frame[joint].rotation));
    }
    text += line + "\n";
  }
  return text;
}

}  // namespace furrow::authoring
