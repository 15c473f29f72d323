// SPDX-License-Identifier: Apache-2.0
#include "render/request/request_check.h"

#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include "base/status.h"
#include "render/request/subjects.h"
#include "render/settings/named_settings.h"

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

// NaN fails every comparison, so the tests ask for valid values.
Status CheckCamera(const Camera& camera, int num_joints) {
  if (!IsFinite(camera.position)) return Invalid("camera.position", "is not finite");
  if (!IsFinite(camera.target)) return Invalid("camera.target", "is not finite");
  if (!(glm::length(camera.target - camera.position) > 1e-4f)) {
    return Invalid("camera.target", "must differ from camera.position");
  }
  if (!(camera.fov_y_degrees >= 1.0f && camera.fov_y_degrees <= 150.0f)) {
    return Invalid("camera.fov_y_degrees",
                   std::to_string(camera.fov_y_degrees) + " is outside [1, 150]");
  }
  for (const auto& [field, joint] : {std::pair("camera.follow_joint", camera.follow_joint),
                                     std::pair("camera.turn_joint", camera.turn_joint)}) {
    if (joint < -1 || joint >= num_joints) {
      return Invalid(field,
                     "no joint " + std::to_string(joint) + " of " + std::to_string(num_joints));
    }
  }
  return {};
}

// `field`: prefix of the subject, "" or "others[3].".
// Infinite numbers would reach bounds, levels of detail and the camera.
Status CheckModel(const std::string& field, std::span<const glm::mat4> model, int num_joints) {
  if (model.size() < static_cast<std::size_t>(num_joints)) {
    return {
        StatusCode::kInvalidArgument,
        std::to_string(model.size()) + " matrices for " + std::to_string(num_joints) + " joints",
        field + "model"};
  }
  for (int joint = 0; joint < num_joints; ++joint) {
    for (int column = 0; column < 4; ++column) {
      if (IsFinite(glm::vec3(model[joint][column]))) continue;
      return {StatusCode::kNonFinite,
              "the matrix of joint " + std::to_string(joint) + " is not finite", field + "model"};
    }
  }
  return {};
}

Status CheckShapes(const std::string& field, std::span<const float> shapes,
                   std::size_t num_shapes) {
  if (!shapes.empty() && shapes.size() != num_shapes) {
    return {
        StatusCode::kInvalidArgument,
        std::to_string(shapes.size()) + " weights for " + std::to_string(num_shapes) + " shapes",
        field + "shapes"};
  }
  for (std::size_t shape = 0; shape < shapes.size(); ++shape) {
    if (std::isfinite(shapes[shape])) continue;
    return {StatusCode::kNonFinite,
            "the weight of shape " + std::to_string(shape) + " is not finite", field + "shapes"};
  }
  return {};
}

// Returns true for rotation, uniform scale and translation. The shaders rotate directions with the
// matrix itself, and a mirrored mesh would turn its triangles inside out.
bool IsRigidButForScale(const glm::mat4& placement) {
  const glm::mat3 turn(placement);
  const float scale2 = glm::dot(turn[0], turn[0]);
  if (!(scale2 > 1e-12f) || !(glm::determinant(turn) > 0.0f)) return false;
  const glm::mat3 product = glm::transpose(turn) * turn;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      const float expected = column == row ? scale2 : 0.0f;
      if (std::abs(product[column][row] - expected) > 1e-3f * scale2) return false;
    }
  }
  const glm::vec4 last(placement[0].w, placement[1].w, placement[2].w, placement[3].w);
  return last == glm::vec4(0.0f, 0.0f, 0.0f, 1.0f);
}

Status CheckPlacement(const std::string& field, const glm::mat4& placement) {
  for (int column = 0; column < 4; ++column) {
    if (IsFinite(glm::vec3(placement[column]))) continue;
    return {StatusCode::kNonFinite, "is not finite", field + "placement"};
  }
  if (IsRigidButForScale(placement)) return {};
  return {StatusCode::kInvalidArgument,
          "must consist of rotation, uniform scale and translation only", field + "placement"};
}

Status CheckSubjects(const FrameRequest& request, int num_joints, std::size_t num_shapes) {
  const std::size_t count = 1 + request.others.size();
  if (count > static_cast<std::size_t>(kMaxSubjects)) {
    return {
        StatusCode::kLimit,
        std::to_string(count) + " subjects; a picture has at most " + std::to_string(kMaxSubjects),
        "others"};
  }
  for (const auto& [subject, field] : SubjectsOf(request)) {
    FURROW_RETURN_IF_ERROR(CheckModel(field, subject->model, num_joints));
    FURROW_RETURN_IF_ERROR(CheckShapes(field, subject->shapes, num_shapes));
    FURROW_RETURN_IF_ERROR(CheckPlacement(field, subject->placement));
  }
  return {};
}

}  // namespace

Status CheckRequest(const FrameRequest& request, int num_joints, std::size_t num_shapes) {
  FURROW_RETURN_IF_ERROR(CheckSize("width", request.width));
  FURROW_RETURN_IF_ERROR(CheckSize("height", request.height));
  if (!(request.scale >= kMinScale && request.scale <= 1.0f)) {
    return {StatusCode::kInvalidArgument, "must be in [0.5, 1]", "scale"};
  }
  FURROW_RETURN_IF_ERROR(CheckSettings(request.settings));
  FURROW_RETURN_IF_ERROR(CheckCamera(request.camera, num_joints));
  return CheckSubjects(request, num_joints, num_shapes);
}

}  // namespace furrow::render
