// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/strain/strain_fields.h"

#include <cmath>
#include <string>
#include <string_view>
#include <unordered_set>

#include "base/ascii.h"
#include "wrinkle/drivers/common/full_pose_builder.h"
#include "wrinkle/drivers/strain/strain.h"
#include "wrinkle/fields/field_check.h"
#include "wrinkle/fields/rig_field.h"

namespace furrow::wrinkle {
namespace {

void CheckPatchVertex(const StrainDriver::Vertex& vertex, const std::string& at,
                      std::size_t num_joints, FieldCheck* check) {
  check->Finite(at, ".position", vertex.position);
  check->Count(at, ".joints", vertex.joints.size(), StrainDriver::kMaxInfluences);
  check->Require(!vertex.joints.empty(), at, ".joints", "no joint moves the vertex");
  check->Require(vertex.joints.size() == vertex.skin_weights.size(), at, ".skin_weights",
                 "the lists of joints and skin weights differ in length",
                 "give one skin weight per joint");
  float sum = 0.0f;
  for (const float skin_weight : vertex.skin_weights) {
    check->Range(at, ".skin_weights", skin_weight, 0.0f, 1.0f);
    sum += skin_weight;
  }
  check->Require(std::abs(sum - 1.0f) <= 0.01f, at, ".skin_weights",
                 "the skin weights do not sum to 1 within 0.01");
  for (const int joint : vertex.joints) {
    check->Require(joint >= 0 && static_cast<std::size_t>(joint) < num_joints, at, ".joints",
                   "there is no such joint in the driver's list");
  }
}

void CheckPatchShape(const StrainDriver::Shape& shape, const std::string& at,
                     std::size_t num_vertices, FieldCheck* check) {
  check->Label(at, ".blend_shape", shape.blend_shape);
  check->Require(shape.deltas.size() == 3 * shape.vertices.size(), at, ".deltas",
                 "the list does not have three numbers per vertex",
                 "give x, y and z for each entry of `vertices`");
  std::unordered_set<int> seen;
  for (const int vertex : shape.vertices) {
    check->Require(vertex >= 0 && static_cast<std::size_t>(vertex) < num_vertices, at, ".vertices",
                   "an index is not below the number of vertices");
    check->Require(seen.insert(vertex).second, at, ".vertices", "a vertex occurs twice");
  }
  for (const float delta : shape.deltas) {
    check->Range(at, ".deltas", delta, -kMaxSkeletonSize, kMaxSkeletonSize);
  }
}

// True if some triangle has an area that can be compressed. Precondition: all indices are valid.
bool HasArea(const StrainDriver& strain) {
  for (std::size_t i = 0; i + 2 < strain.triangles.size(); i += 3) {
    const auto corner = [&](std::size_t k) {
      return strain.vertices[static_cast<std::size_t>(strain.triangles[i + k])].position;
    };
    if (MakeRestTriangle(corner(0), corner(1), corner(2), strain.direction)) return true;
  }
  return false;
}

}  // namespace

std::vector<std::string> DriverValueNames(const StrainDriver&) {
  return {"along", "across", "diagonal_left", "diagonal_right"};
}

void CheckFields(const StrainDriver& driver, const std::string& at, FieldCheck* check) {
  check->Label(at, ".joint", driver.joint);
  check->Count(at, ".joints", driver.joints.size(), kMaxPatchJoints);
  check->Count(at, ".vertices", driver.vertices.size(), kMaxPatchVertices);
  check->Count(at, ".triangles", driver.triangles.size(), 3 * kMaxPatchTriangles);
  check->Count(at, ".shapes", driver.shapes.size(), kMaxPatchShapes);
  std::unordered_set<std::string_view> joints;
  for (std::size_t i = 0; i < driver.joints.size(); ++i) {
    check->Label(FieldAt(at + ".joints", i), "", driver.joints[i]);
    check->Once(FieldAt(at + ".joints", i), "", driver.joints[i], &joints);
  }
  for (std::size_t i = 0; i < driver.vertices.size(); ++i) {
    CheckPatchVertex(driver.vertices[i], FieldAt(at + ".vertices", i), driver.joints.size(), check);
  }
  std::unordered_set<std::string> shapes;
  for (std::size_t i = 0; i < driver.shapes.size(); ++i) {
    const std::string shape_at = FieldAt(at + ".shapes", i);
    CheckPatchShape(driver.shapes[i], shape_at, driver.vertices.size(), check);
    check->Require(shapes.insert(AsciiLower(driver.shapes[i].blend_shape)).second, shape_at,
                   ".blend_shape", "the blend shape occurs twice");
  }
  check->Require(driver.triangles.size() % 3 == 0, at, ".triangles",
                 "a triangle has three vertices");
  bool in_range = true;
  for (const int vertex : driver.triangles) {
    in_range = in_range && vertex >= 0 && static_cast<std::size_t>(vertex) < driver.vertices.size();
  }
  check->Require(in_range, at, ".triangles", "an index is not below the number of vertices");
  check->Direction(at, ".direction", driver.direction);
  check->Range(at, ".full_compression", driver.full_compression, 0.01f, 1.0f);
  check->Range(at, ".size", driver.size, 0.0f, kMaxSkeletonSize);
  // HasArea() indexes the vertices, so it runs only if all indices are in range.
  check->Require(!in_range || HasArea(driver), at, ".triangles",
                 "no triangle has an area that could be compressed");
}

std::vector<std::string> JointsRead(const StrainDriver& driver) {
  std::vector<std::string> joints = {driver.joint};
  joints.insert(joints.end(), driver.joints.begin(), driver.joints.end());
  return joints;
}

std::vector<std::string> BlendShapesRead(const StrainDriver& driver) {
  std::vector<std::string> names;
  for (const StrainDriver::Shape& shape : driver.shapes) names.push_back(shape.blend_shape);
  return names;
}

std::vector<std::string> JointsInfluenced(const StrainDriver& driver) { return driver.joints; }

Result<ReferencePose> FullPose(const StrainDriver&, const FullPoseBuilder& builder) {
  return builder.Unsupported();
}

}  // namespace furrow::wrinkle
