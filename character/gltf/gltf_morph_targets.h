// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "base/status.h"
#include "character/mesh/mesh.h"
#include "gltf/document/accessor.h"
#include "gltf/document/document.h"
#include "gltf/limits.h"
#include "gltf/scene/meshes.h"

namespace furrow::character {

// Reads the morph targets of all primitives of a file and unites them by name: targets of equal
// names on different meshes are one shape.
//
// - A delta is dropped if it is zero: its length is at most 1e-7 of the mesh's largest extent, and
//   it turns neither the normal nor the tangent by more than 1e-4.
// - Vertices without a triangle have no deltas. Exporters that share one vertex list among
//   primitives write the same targets into each of them.
// - A shape that moves nothing is left out; see idle_names(). DropFaintShapes() removes those that
//   hardly move anything, once all meshes are in one space.
// - An expression of a VRM avatar is a shape of its own, the sum of the targets that it binds.
// - Shapes beyond kMaxShapes are left out; see num_surplus().
class GltfMorphTargets {
 public:
  explicit GltfMorphTargets(const gltf::Document& document) : document_(document) {}

  struct Base {
    bool has_normals = false;   // the file's normals are in use: deltas of normals fit them
    bool has_tangents = false;  // likewise
  };

  // Fills Mesh::morph_targets of a mesh with vertices and indices, in the space of its vertices.
  // Targets without normals get computed ones; see ComputeMorphNormals(). `at` names the primitive
  // ("meshes[0].primitives[1]").
  //
  // Errors: Accessor::Create()'s, kSchema (counts that differ), kNonFinite, kLimit (gltf/limits.h).
  [[nodiscard]] Status Read(const gltf::Mesh& from, const gltf::Primitive& primitive,
                            const std::string& at, const Base& base, Mesh* mesh);

  // The shapes that move a vertex, in order of first appearance: Character::shapes.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  // Shapes that the file names and that move no vertex of any mesh, in order of first appearance.
  [[nodiscard]] std::vector<std::string> idle_names() const;
  // Shapes left out because there are kMaxShapes others.
  [[nodiscard]] std::size_t num_surplus() const { return surplus_.size(); }

 private:
  // A target of the present primitive.
  struct Found {
    MorphTarget target;
    int index = -1;              // in the file; -1: a mix
    bool lacks_normals = false;  // for ComputeMorphNormals()
  };
  // An attribute of a target.
  struct Part {
    const char* name;
    gltf::Accessor accessor;
    glm::vec3 MorphDelta::*member;
  };
  // Adds the mixes of the mesh, each as a target of its own.
  Status AddMixes(const gltf::Mesh& from, const std::string& at, std::vector<Found>* found);
  // Opens the attributes of a target, and counts their elements.
  Status OpenTarget(const gltf::MorphTarget& target, const std::string& at, const Base& base,
                    const Mesh& mesh, std::vector<Part>* parts);
  static Status ReadDeltas(const std::vector<Part>& parts, const std::string& at,
                           std::vector<MorphDelta>* deltas);
  // Index in names(), or -1 for a surplus shape.
  int ShapeOf(const std::string& name);

  const gltf::Document& document_;
  std::vector<std::string> names_;
  std::unordered_map<std::string, int> index_of_;
  std::vector<std::string> stated_;  // all names of the file, unique
  std::unordered_set<std::string> is_stated_;
  std::unordered_set<std::string> surplus_;
  // What the targets of the file may still use. The size of the file does not bound that: accessors
  // may be sparse, and many may share one buffer.
  std::size_t elements_ = gltf::kMaxMorphElements;
  std::size_t deltas_ = gltf::kMaxMorphDeltas;
};

}  // namespace furrow::character
