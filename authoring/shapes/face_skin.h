// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "authoring/shapes/arkit_face.h"
#include "base/status.h"
#include "character/character.h"

namespace furrow::authoring {

// The skin of a face that blend shapes move, welded by position: what browDown and mouthSmile both
// move, and the other meshes of the same material. Eyes, hair, lashes and teeth are not skin.
class FaceSkin {
 public:
  // `character` and `face`, which is made from it, must outlive the result. Error: kNotFound (a
  // shape of HasShapeFace() is missing, or no mesh is moved by both brows and mouth).
  [[nodiscard]] static Result<FaceSkin> Create(const character::Character& character,
                                               const ArkitFace& face);

  // Indices into Character::meshes, and the material that they share (-1: none).
  [[nodiscard]] std::span<const int> meshes() const { return meshes_; }
  [[nodiscard]] int material() const { return material_; }
  // Metres, model space, rest pose.
  [[nodiscard]] std::span<const glm::vec3> positions() const { return positions_; }
  // The welded vertex of each vertex of meshes()[i].
  [[nodiscard]] std::span<const std::uint32_t> welded(std::size_t i) const { return welded_[i]; }
  // The vertices that share an edge with `vertex`, ascending.
  [[nodiscard]] std::span<const std::uint32_t> Around(std::size_t vertex) const {
    return neighbours_[vertex];
  }

  // The triangles of all meshes, as welded vertices.
  [[nodiscard]] std::vector<std::array<std::uint32_t, 3>> Triangles() const;

  // How far ARKit's blend shape `name` moves each vertex at weight 1, metres. Empty if the
  // character has nothing like it (ArkitFace::Has()), or if it moves the skin by less than 1e-4 of
  // the head's height: a name proves nothing.
  [[nodiscard]] std::vector<glm::vec3> Moves(std::string_view name) const;

  // The x between the eyes, and the distance between the upper lids of both eyes, metres.
  [[nodiscard]] float middle() const { return middle_; }
  [[nodiscard]] float eye_distance() const { return eye_distance_; }

 private:
  FaceSkin() = default;
  void FindMeshes();
  void Weld();
  [[nodiscard]] Status MeasureEyes();
  [[nodiscard]] std::vector<glm::vec3> AllMoves(std::string_view name) const;

  const character::Character* character_ = nullptr;
  const ArkitFace* face_ = nullptr;
  std::vector<int> meshes_;
  int material_ = -1;
  std::vector<glm::vec3> positions_;
  std::vector<std::vector<std::uint32_t>> welded_;
  std::vector<std::vector<std::uint32_t>> neighbours_;
  float middle_ = 0.0f;
  float eye_distance_ = 0.0f;
};

}  // namespace furrow::authoring
