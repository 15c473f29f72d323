// SPDX-License-Identifier: Apache-2.0
// Only this folder includes assimp's headers; other code sees glTF.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <assimp/Importer.hpp>
#include <assimp/scene.h>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "base/status.h"
#include "wrinkle/skeleton/transform.h"

namespace furrow::authoring {

// assimp stores rows, GLM columns.
[[nodiscard]] inline glm::mat4 ToGlm(const aiMatrix4x4& m) {
  return glm::transpose(glm::make_mat4(&m.a1));
}
[[nodiscard]] inline glm::vec3 ToGlm(const aiVector3D& v) { return {v.x, v.y, v.z}; }

// What a file is read for: its meshes and materials, or its animation. For kAnimation, FBX's pivots
// stay separate nodes, and materials and pictures are skipped.
enum class Purpose { kModel, kAnimation };

// Reads a file with assimp. `extension` selects the format (".fbx"). No other files are read.
// `importer` owns the scene. Nodes of Collada have their names, or their ids if two nodes have one
// name.
//
// Errors: kParse, with assimp's reason; kUnsupported (an extension that assimp does not know).
// Throws std::bad_alloc.
[[nodiscard]] Result<const aiScene*> ReadScene(std::string_view bytes, const std::string& extension,
                                               Purpose purpose, Assimp::Importer* importer);

// The axes and unit that the file states, as a rotation and scale of the whole scene to metres and
// +Y up. Appends a sentence to `remarks` for each that differs. Collada states them as the
// transform of the root node, so this is the identity.
[[nodiscard]] wrinkle::Transform SpaceOf(const aiScene& scene, std::vector<std::string>* remarks);

// One line of at most 300 bytes: control characters become blanks.
[[nodiscard]] std::string OneLine(std::string text);

}  // namespace furrow::authoring
