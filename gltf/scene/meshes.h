// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "base/status.h"
#include "gltf/document/document.h"
#include "gltf/scene/nodes.h"

namespace furrow::gltf {

// One morph target of a primitive: accessors of deltas (VEC3), kNone where the file has none.
struct MorphTarget {
  int position = kNone;
  int normal = kNone;
  int tangent = kNone;
};

// What the indices of a primitive make.
enum class PrimitiveKind {
  kTriangles,  // three indices each
  kStrip,      // each index makes a triangle with the two before
  kFan,        // each index makes a triangle with the one before and the first
  kOther,      // points and lines
};

// A part of a mesh with one material. Accessors are indices; Accessor::Create() checks them.
struct Primitive {
  PrimitiveKind kind = PrimitiveKind::kTriangles;
  std::map<std::string, int> attributes;   // "POSITION" -> accessor
  int indices = kNone;                     // accessor; kNone: vertices in order
  int material = kNone;                    // checked: in range
  std::vector<MorphTarget> morph_targets;  // at most Mesh::morph_target_names
};

// Morph targets of one mesh that an expression moves together.
struct MorphMix {
  std::string name;
  std::vector<std::pair<int, float>> targets;  // index in morph_target_names, weight
};

struct Mesh {
  // Else that of the first node with this mesh, else that of a node above one, else "mesh_<index>".
  std::string name;
  std::vector<Primitive> primitives;
  std::vector<std::string> morph_target_names;  // unique; see ReadMeshes()
  std::vector<MorphMix> mixes;                  // VRM's expressions; see ReadMeshes()
};

// All meshes of a document with Contents::kCharacter.
//
// A morph target without a name in `extras.targetNames` is called "<mesh>.<index>". A name that the
// mesh has already gets "_2", "_3" and so on, and a warning. Names longer than kMaxNameBytes are
// cut.
//
// An expression of VRM (ReadVrmExpressions()) becomes a mix of each mesh that it moves, unless a
// morph target of the document already has its name, in any case.
//
// Errors: kSchema (a material that does not exist); those of ReadVrmExpressions().
[[nodiscard]] Result<std::vector<Mesh>> ReadMeshes(Document* document);

struct Bounds {
  glm::vec3 low;
  glm::vec3 high;
};

// The bounds of the meshes without a skin on a node and below it, in the node's space at rest, of a
// document with Contents::kCharacter. They follow from the bounds that the file states for each
// mesh. nullopt if a mesh states none, or states them as normalised integers.
[[nodiscard]] std::optional<Bounds> BoundsOfPart(const Document& document, const NodeForest& forest,
                                                 int node);

}  // namespace furrow::gltf
