// SPDX-License-Identifier: Apache-2.0
#include "motion/bvh/bvh_positions.h"

#include <cstddef>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "base/text.h"

namespace furrow::motion {
namespace {

// 1 for each axis on which the joint has a position channel.
glm::vec3 PositionAxes(const BvhJointChannels& channels) {
  glm::vec3 axes(0.0f);
  for (int i = 0; i < channels.count; ++i) {
    const int channel = static_cast<int>(channels.channels[static_cast<std::size_t>(i)]);
    if (channel < 3) axes[channel] = 1.0f;
  }
  return axes;
}

// True if the joint stays within a hundredth of its offset of the position 0, on the axes with
// channels. Exporters that compute positions write small errors instead of zeros.
bool StaysAtZero(const Clip& clip, std::size_t joint, const glm::vec3& offset,
                 const glm::vec3& axes) {
  const float near = 0.01f * glm::length(offset);
  const auto joints = static_cast<std::size_t>(clip.skeleton.num_joints());
  for (std::size_t at = joint; at < clip.locals.size(); at += joints) {
    if (glm::length(clip.locals[at].translation * axes) > near) return false;
  }
  return true;
}

}  // namespace

void AddPositionsThatCollapse(const BvhHierarchy& hierarchy, float scale,
                              std::string_view source_name, Clip* clip, ClipReport* report) {
  const std::size_t joints = hierarchy.joints.size();
  std::vector<glm::vec3> offsets(joints, glm::vec3(0.0f));  // that the channels replaced
  std::size_t replaced = 0;
  std::size_t at_zero = 0;
  for (std::size_t j = 0; j < joints; ++j) {
    if (hierarchy.joints[j].parent == wrinkle::kNoJoint) continue;
    const glm::vec3 axes = PositionAxes(hierarchy.channels[j]);
    offsets[j] = hierarchy.joints[j].rest.translation * scale * axes;
    if (offsets[j] == glm::vec3(0.0f)) continue;
    ++replaced;
    if (StaysAtZero(*clip, j, offsets[j], axes)) ++at_zero;
  }
  if (2 * at_zero <= replaced) return;
  for (std::size_t at = 0; at < clip->locals.size(); ++at) {
    clip->locals[at].translation += offsets[at % joints];
  }
  if (report == nullptr) return;
  report->warnings.push_back(std::string(source_name) + ": the position channels of " +
                             Counted(at_zero, "joint") +
                             " are 0 in every frame, which would collapse the body; they are added "
                             "to the OFFSETs (--bvh-positions channels takes them as they are)");
}

}  // namespace furrow::motion
