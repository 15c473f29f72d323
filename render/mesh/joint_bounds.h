// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <glm/common.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "character/character.h"
#include "render/mesh/screen_rect.h"
#include "render/mesh/view_sides.h"

namespace furrow::render {

// Bounds of a posed character on the screen, computed without skinning a vertex. Each joint has a
// box around all vertices that it moves. A skinned vertex is a weighted mean of points in its
// joints' boxes, so a region that contains all boxes contains the surface. Each morph target moves
// the sides of the boxes by its largest deltas, in proportion to its weight.
class JointBounds {
 public:
  JointBounds() = default;
  // Bounds of the meshes for which `accept` returns true for the material.
  JointBounds(const character::Character& character,
              const std::function<bool(const character::Material&)>& accept);
  // Bounds of one mesh.
  JointBounds(const character::Mesh& mesh, std::span<const glm::mat4> inverse_bind_matrices);
  // Bounds of some vertices of a mesh, as numbers in `vertices`, without its morph targets.
  JointBounds(const character::Mesh& mesh, std::span<const std::uint32_t> vertices,
              std::span<const glm::mat4> inverse_bind_matrices);

  struct Pose {
    // Joint matrices in model space, one per joint of the character's skeleton.
    std::span<const glm::mat4> model;
    // Weights of the character's shapes; missing ones count as 0.
    std::span<const float> shapes;
  };
  // The projected boxes.
  struct Extent {
    glm::vec2 low{0.0f};  // normalised device coordinates; the picture is [-1, 1]
    glm::vec2 high{0.0f};
    float nearest = 0.0f;  // clip-space w of the nearest corner; 0, with low and high meaningless,
                           // if a corner is behind the camera

    [[nodiscard]] Extent With(const Extent& other) const {
      return {glm::min(low, other.low), glm::max(high, other.high),
              std::min(nearest, other.nearest)};
    }
    // The pixels of a picture of `width` x `height` that the boxes may cover.
    [[nodiscard]] ScreenRect Pixels(int width, int height) const;
    // False only if no part of the boxes is in the picture.
    [[nodiscard]] bool is_seen() const {
      return nearest <= 0.0f || (low.x < 1.0f && high.x > -1.0f && low.y < 1.0f && high.y > -1.0f);
    }
  };
  // Projects the boxes. `view_projection`: model space to clip space. `reach`: largest distance in
  // metres between the drawn surface and the one that the pose gives (displacement).
  [[nodiscard]] Extent Look(const Pose& pose, const glm::mat4& view_projection,
                            float reach = 0.0f) const;

  // Returns true only if all boxes, enlarged by `reach` metres, are beyond one side. Disregards
  // morph targets.
  [[nodiscard]] bool IsBeyond(const ViewSides& sides, float reach) const;

  // Returns the pixels of a picture of `width` x `height` that the boxes may cover: the whole
  // picture if a box reaches behind the camera, and an empty rectangle if there are no boxes.
  [[nodiscard]] ScreenRect Project(const Pose& pose, const glm::mat4& view_projection, int width,
                                   int height, float reach = 0.0f) const;

 private:
  void Add(const character::Mesh& mesh, std::span<const glm::mat4> inverse_bind_matrices);

  struct Box {
    int joint = 0;
    glm::vec3 low{0.0f};  // in the joint's space
    glm::vec3 high{0.0f};
  };
  // How far a shape at weight 1 moves the vertices of a box: between `low` and `high`, which
  // enclose 0, because a target does not move all vertices.
  struct Move {
    std::size_t box = 0;
    std::size_t shape = 0;
    glm::vec3 low{0.0f};  // in the joint's space
    glm::vec3 high{0.0f};
  };
  // Of the vertices vertex_of(0) to vertex_of(count - 1).
  template <class VertexOf>
  void AddBoxes(std::size_t count, const VertexOf& vertex_of,
                std::span<const glm::mat4> inverse_bind_matrices);
  void AddMoves(const character::Mesh& mesh, std::span<const glm::mat4> inverse_bind_matrices,
                std::size_t first_box);
  [[nodiscard]] std::vector<Box> MovedBoxes(std::span<const float> shapes) const;

  std::vector<Box> boxes_;
  std::vector<Move> moves_;
};

}  // namespace furrow::render
