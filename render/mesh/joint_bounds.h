// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "character/character.h"
#include "render/mesh/screen_rect.h"

namespace furrow::render {

// Where on the screen a posed character can be, without skinning a vertex: a box a joint around all
// vertices that it moves. A skinned vertex is a mean of places in its joints' boxes, so what holds
// all boxes holds the surface.
class JointBounds {
 public:
  JointBounds() = default;
  // Of the meshes whose material `accept` takes.
  JointBounds(const character::Character& character,
              const std::function<bool(const character::Material&)>& accept);
  // Of one mesh.
  JointBounds(const character::Mesh& mesh, std::span<const glm::mat4> inverse_bind_matrices);

  // What the boxes are to one who looks at them.
  struct Extent {
    glm::vec2 low{0.0f};  // of the picture, which is [-1, 1]
    glm::vec2 high{0.0f};
    float nearest = 0.0f;  // clip space's w of the nearest corner; 0: some of it lies behind

    [[nodiscard]] bool is_seen() const {
      return nearest <= 0.0f || (low.x < 1.0f && high.x > -1.0f && low.y < 1.0f && high.y > -1.0f);
    }
  };
  // `model`: a pose of the character's skeleton. `reach`: metres that the surface may stand off
  // what was skinned, in any direction.
  [[nodiscard]] Extent Look(std::span<const glm::mat4> model, const glm::mat4& view_projection,
                            float reach = 0.0f) const;

  // The pixels of a picture that the boxes may cover; the whole picture where one reaches behind
  // the camera; none where there are no boxes.
  [[nodiscard]] ScreenRect Project(std::span<const glm::mat4> model,
                                   const glm::mat4& view_projection, int width, int height,
                                   float reach = 0.0f) const;

 private:
  void Add(const character::Mesh& mesh, std::span<const glm::mat4> inverse_bind_matrices);

  struct Box {
    int joint = 0;
    glm::vec3 low{0.0f};  // in the joint's space
    glm::vec3 high{0.0f};
  };
  std::vector<Box> boxes_;
};

}  // namespace furrow::render
