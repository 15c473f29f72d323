// SPDX-License-Identifier: Apache-2.0
#include "render/scene/camera_frame.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace furrow::render {
namespace {

constexpr glm::vec3 kUp(0.0f, 1.0f, 0.0f);

// The rotation's angle about +Y by swing-twist decomposition, radians.
float Heading(const glm::mat4& rotation) {
  const glm::quat q = glm::quat_cast(glm::mat3(glm::normalize(glm::vec3(rotation[0])),
                                               glm::normalize(glm::vec3(rotation[1])),
                                               glm::normalize(glm::vec3(rotation[2]))));
  return 2.0f * std::atan2(q.y, q.w);
}

}  // namespace

glm::mat4 FollowTransform(const Camera& camera, const wrinkle::Skeleton& skeleton,
                          std::span<const glm::mat4> model) {
  const int joint = camera.follow_joint;
  if (joint < 0 || joint >= skeleton.num_joints()) return glm::mat4(1.0f);
  // The camera takes the joint's movement but only the body's turn. Following the joint's own
  // rotation would hide nods and shake the picture.
  int body = camera.turn_joint;
  if (body < 0 || body >= skeleton.num_joints()) {
    body = joint;
    while (skeleton.joint_parents()[body] != wrinkle::kNoJoint)
      body = skeleton.joint_parents()[body];
  }
  const float turn = Heading(model[body] * glm::inverse(skeleton.rest_model()[body]));
  const glm::vec3 from(skeleton.rest_model()[joint][3]);
  const glm::vec3 to(model[joint][3]);
  return glm::translate(glm::mat4(1.0f), to) * glm::rotate(glm::mat4(1.0f), turn, kUp) *
         glm::translate(glm::mat4(1.0f), -from);
}

CameraFrame ComputeCamera(const Camera& camera, const wrinkle::Skeleton& skeleton,
                          std::span<const glm::mat4> model, float aspect,
                          const glm::mat4& placement) {
  const glm::mat4 follow = camera.follow_joint < 0
                               ? glm::mat4(1.0f)
                               : placement * FollowTransform(camera, skeleton, model);
  const glm::vec3 position(follow * glm::vec4(camera.position, 1.0f));
  const glm::vec3 target(follow * glm::vec4(camera.target, 1.0f));
  const glm::vec3 towards = target - position;
  const float distance = glm::length(towards);
  // A camera that looks straight up or down cannot use +Y as its up direction.
  const bool steep = std::abs(towards.y) > 0.999f * distance;
  const glm::mat4 view = glm::lookAt(position, target, steep ? glm::vec3(0, 0, -1) : kUp);
  const float narrow = camera.fit_shorter_side ? std::min(aspect, 1.0f) : 1.0f;
  const float half_height = std::tan(glm::radians(0.5f * camera.fov_y_degrees)) / narrow;
  // Planes relative to the distance: close-ups are not cut off, and depth stays precise for whole
  // bodies.
  const float near_plane = 0.05f * distance;
  const float far_plane = 20.0f * distance;
  const glm::mat4 projection =
      glm::perspective(2.0f * std::atan(half_height), aspect, near_plane, far_plane);
  const float heading = steep ? 0.0f : std::atan2(-towards.x, -towards.z);
  const glm::mat3 turn(glm::rotate(glm::mat4(1.0f), heading, kUp));
  return {projection * view,  position,   view,      target,
          1.0f / half_height, near_plane, far_plane, turn};
}

}  // namespace furrow::render
