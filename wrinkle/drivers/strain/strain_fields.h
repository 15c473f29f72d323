// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "wrinkle/skeleton/reference_pose.h"

namespace furrow::wrinkle {

class FieldCheck;
class FullPoseBuilder;

// Limits of one strain driver. The whole patch is computed on the stack.
inline constexpr std::size_t kMaxPatchVertices = 256;
inline constexpr std::size_t kMaxPatchTriangles = 512;
inline constexpr std::size_t kMaxPatchJoints = 32;
inline constexpr std::size_t kMaxPatchShapes = 512;

// How strongly a patch of the skinned surface is compressed, and in which direction. Values
// "along", "across", "diagonal_left" and "diagonal_right" refer to a direction in the surface, so
// that one place can fold along or across. Their sum is the principal compression divided by
// `full_compression` (strain.h).
//
// The rig stores the patch as points, skin weights and the deltas of blend shapes, and therefore
// needs no mesh. `furrow rig patch` cuts a patch out of a character.
struct StrainDriver {
  static constexpr bool kMeasuresFromAnchor = false;
  static constexpr bool kAddsJoints = false;
  static constexpr int kMaxInfluences = 4;

  struct Vertex {
    glm::vec3 position{0.0f};         // rest pose, model axes, from the origin of `joint`
    std::vector<int> joints;          // into `joints` below, at most kMaxInfluences
    std::vector<float> skin_weights;  // one per joint, > 0, sum 1

    template <class Fields>
    static void ListFields(Fields& fields) {
      fields.Required("position", &Vertex::position);
      fields.Required("joints", &Vertex::joints);
      fields.Required("skin_weights", &Vertex::skin_weights);
    }
  };
  // How a blend shape moves the vertices, before the joints do.
  struct Shape {
    std::string blend_shape;    // matched without case
    std::vector<int> vertices;  // each at most once
    std::vector<float> deltas;  // x, y and z per vertex at coefficient 1, in the unit of `position`

    template <class Fields>
    static void ListFields(Fields& fields) {
      fields.Required("blend_shape", &Shape::blend_shape);
      fields.Required("vertices", &Shape::vertices);
      fields.Required("deltas", &Shape::deltas);
    }
  };
  std::string joint;                // positions are measured from its origin
  std::vector<std::string> joints;  // the joints that move the patch
  std::vector<Vertex> vertices;
  std::vector<int> triangles;             // three vertices each, counter-clockwise from outside
  std::vector<Shape> shapes;              // the blend shapes that move the patch
  glm::vec3 direction{1.0f, 0.0f, 0.0f};  // model axes, rest pose; projected into the surface
  float full_compression = 0.25f;         // the compression that gives 1, [0.01, 1]
  float size = 0.0f;  // SkeletonSize() the positions were measured on; 0: bound skeleton's units

  // The fields as strain.fbs names them, in the order in which they are written.
  template <class Fields>
  static void ListFields(Fields& fields) {
    fields.Required("joint", &StrainDriver::joint);
    fields.Required("direction", &StrainDriver::direction);
    fields.Optional("full_compression", &StrainDriver::full_compression);
    fields.Optional("size", &StrainDriver::size);
    fields.Required("joints", &StrainDriver::joints);
    fields.Required("vertices", &StrainDriver::vertices);
    fields.Required("triangles", &StrainDriver::triangles);
    fields.Optional("shapes", &StrainDriver::shapes);
  }
};

[[nodiscard]] std::vector<std::string> DriverValueNames(const StrainDriver& driver);
void CheckFields(const StrainDriver& driver, const std::string& at, FieldCheck* check);
[[nodiscard]] std::vector<std::string> JointsRead(const StrainDriver& driver);
[[nodiscard]] std::vector<std::string> BlendShapesRead(const StrainDriver& driver);
[[nodiscard]] std::vector<std::string> JointsInfluenced(const StrainDriver& driver);
// Always kUnsupported: many poses compress a patch fully.
[[nodiscard]] Result<ReferencePose> FullPose(const StrainDriver& driver,
                                             const FullPoseBuilder& builder);

}  // namespace furrow::wrinkle
