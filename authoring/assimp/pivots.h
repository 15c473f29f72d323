// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <assimp/anim.h>
#include <assimp/scene.h>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>

#include "base/status.h"
#include "gltf/scene/transform.h"

// FBX joints as assimp 5.2 hands them over. An FBX joint's local transform is a product:
//
//   T * Roff * Rp * Rpre * R * Rpost^-1 * Rp^-1 * Soff * Sp * S * Sp^-1
//
// For joints that use more than T, R and S, assimp makes a node of each factor, a parent of the
// next, and of the joint itself last. This header joins them again. Other formats have chains of
// one node.
namespace furrow::authoring {

// A node of the file with its factors.
struct SceneNode {
  std::string name;
  int parent = -1;                     // index in the same list, before this node; -1 for a root
  std::vector<const aiNode*> factors;  // the first is applied last; the node itself is last
};

// All nodes below the root, parents first. Geometric offsets are left out: they move a node's mesh,
// not the node. Error: kLimit (gltf::kMaxNodes).
[[nodiscard]] Result<std::vector<SceneNode>> ListNodes(const aiScene& scene);

// The local transform of a node when nothing moves.
[[nodiscard]] gltf::Transform RestOf(const SceneNode& node);

// The local transform of a node over time.
class NodeMotion {
 public:
  // `channels` has one entry per factor, null for a factor that does not move; they must outlive
  // the object, and CheckChannel() has accepted them.
  NodeMotion(const SceneNode& node, const std::vector<const aiNodeAnim*>& channels);

  // `ticks`: in the animation's unit. Times outside of the keys give the first or last key.
  [[nodiscard]] gltf::Transform At(double ticks) const;

 private:
  struct Factor {
    glm::dmat4 rest;
    gltf::Transform parts;      // of `rest`
    const aiNodeAnim* channel;  // null: `rest`
    // Axes of `channel` that no curve moves. assimp 5.2 gives them the factor's default instead of
    // the joint's own value.
    glm::bvec3 unmoved_position{false};
    glm::bvec3 unmoved_scale{false};
  };
  [[nodiscard]] static Factor FactorOf(const aiNode& node, const aiNodeAnim* channel);

  std::vector<Factor> factors_;
  glm::dquat after_{1.0, 0.0, 0.0, 0.0};  // applied to the rotation of a single factor
};

// Checks that the keys of a channel are in order and finite. Errors: kSchema, kNonFinite.
[[nodiscard]] Status CheckChannel(const aiNodeAnim& channel);

}  // namespace furrow::authoring
