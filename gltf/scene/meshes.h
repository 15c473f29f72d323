// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "base/status.h"
#include "gltf/document/document.h"
#include "gltf/scene/nodes.h"

namespace furrow::gltf {

// A part of a mesh with one material. Accessors are indices; Accessor::Create() checks them.
struct Primitive {
  bool is_triangles = true;               // false: points, lines, strips or fans
  std::map<std::string, int> attributes;  // "POSITION" -> accessor
  int indices = kNone;                    // accessor; kNone: vertices in order
  int material = kNone;                   // checked: in range
  std::size_t num_morph_targets = 0;
};

struct Mesh {
  std::string name;  // "mesh_<index>" if the file has none
  std::vector<Primitive> primitives;
};

// All meshes of a document with Contents::kCharacter. Errors: kSchema (a material that does not
// exist).
[[nodiscard]] Result<std::vector<Mesh>> ReadMeshes(const Document& document);

}  // namespace furrow::gltf
