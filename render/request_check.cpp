// SPDX-License-Identifier: Apache-2.0
#include "render/request_check.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

namespace furrow::render {
namespace {

Status Invalid(const char* field, std::string what) {
  return {StatusCode::kInvalidArgument, std::move(what), field};
}

bool IsFinite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Status CheckSize(const char* field, int size) {
  if (size >= kMinSize && size <= kMaxSize) return {};
  return Invalid(field, std::to_string(size) + " is outside [" + std::to_string(kMinSize) + ", " +
                            std::to_string(kMaxSize) + "]");
}

Status CheckCamera(const Camera& camera, int num_joints) {
  if (!IsFinite(camera.position)) return Invalid("camera.position", "is not finite");
  if (!IsFinite(camera.target)) return Invalid("camera.target", "is not finite");
  if (!(glm::length(camera.target - camera.position) > 1e-4f)) {
    return Invalid("camera.target", "is where the camera stands");
  }
  if (!(camera.fov_y_degrees >= 1.0f && camera.fov_y_degrees <= 150.0f)) {
    return Invalid("camera.fov_y_degrees",
                   std::to_string(camera.fov_y_degrees) + " is outside [1, 150]");
  }
  if (camera.follow_joint < -1 || camera.follow_joint >= num_joints) {
    return Invalid("camera.follow_joint", "no joint " + std::to_string(camera.follow_joint) +
                                              " of " + std::to_string(num_joints));
  }
  return {};
}

Status CheckModel(std::span<const glm::mat4> model, int num_joints) {
  if (model.size() < static_cast<std::size_t>(num_joints)) {
    return Invalid("model", std::to_string(model.size()) + " matrices for " +
                                std::to_string(num_joints) + " joints");
  }
  for (int joint = 0; joint < num_joints; ++joint) {
    for (int column = 0; column < 4; ++column) {
      if (IsFinite(glm::vec3(model[joint][column]))) continue;
      return {StatusCode::kNonFinite, "the matrix of joint " + std::to_string(joint), "model"};
    }
  }
  return {};
}

}  // namespace

Status CheckRequest(const FrameRequest& request, int num_joints) {
  if (Status status = CheckSize("width", request.width); !status.ok()) return status;
  if (Status status = CheckSize("height", request.height); !status.ok()) return status;
  if (Status status = CheckSettings(request.settings); !status.ok()) return status;
  if (Status status = CheckCamera(request.camera, num_joints); !status.ok()) return status;
  return CheckModel(request.model, num_joints);
}

}  // namespace furrow::render
