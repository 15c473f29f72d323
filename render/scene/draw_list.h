// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "render/request/subjects.h"
#include "render/scene/gpu_character.h"
#include "render/scene/lighting.h"

namespace furrow::render {

// Selects the subjects of each mesh that the camera and the lamps can see, and their level of
// detail.
class DrawList {
 public:
  static constexpr int kCamera = kNumLights;  // index of the camera's view; the lamps' views come
                                              // first
  static constexpr int kNumViews = kNumLights + 1;
  struct View {
    glm::mat4 projection{1.0f};  // model space to clip space
    float pixels = 0.0f;         // pixels per metre where clip space's w is 1
    bool is_active = true;       // false: a lamp that casts no shadow
  };
  struct Tolerance {
    float reach = 0.0f;         // metres between the drawn and the skinned surface, at most
    float error_pixels = 0.0f;  // allowed RMS error of simplified meshes, picture pixels
    float hair_shadow = 0.0f;   // allowed RMS error of hair in shadow maps, metres
  };

  // Replaces the list. `views`: those of the lamps, then the camera's. The other arguments are only
  // used during the call.
  void Build(GpuCharacter* gpu, std::span<const NamedSubject> subjects,
             const std::array<View, kNumViews>& views, const Tolerance& tolerance);

  // The subjects of which any view sees the mesh, as ascending indices of Build()'s `subjects`.
  [[nodiscard]] std::span<const std::uint32_t> subjects(std::size_t mesh) const {
    return meshes_[mesh].subjects;
  }
  // The level of detail (GpuMesh::levels) of each of subjects(). The camera's distance determines
  // it, or the lamps' where the camera does not see the subject. All views use the same level,
  // because a surface would otherwise cast shadows on itself. Only hair is coarser in shadow maps,
  // within the tolerance: it has no smooth surface on which that would show.
  [[nodiscard]] std::span<const int> levels(int view, std::size_t mesh) const {
    return view == kCamera ? meshes_[mesh].levels : meshes_[mesh].shadow_levels;
  }
  // Apparent size of a mesh in the camera's picture, over all subjects.
  struct Sight {
    float pixels = 0.0f;   // pixels per metre of the nearest subject; 0: none is visible
    float covered = 0.0f;  // upper bound of the covered share of the picture, [0, 1] per subject
  };
  [[nodiscard]] const Sight& sight(std::size_t mesh) const { return meshes_[mesh].sight; }
  // The subjects of which view `view` sees the mesh, as positions in subjects(mesh).
  [[nodiscard]] std::span<const std::uint32_t> seen(int view, std::size_t mesh) const {
    return meshes_[mesh].seen[static_cast<std::size_t>(view)];
  }

 private:
  struct Mesh {
    std::vector<std::uint32_t> subjects;
    std::vector<int> levels;
    std::vector<int> shadow_levels;
    Sight sight;
    std::array<std::vector<std::uint32_t>, kNumViews> seen;
  };
  std::vector<Mesh> meshes_;
};

}  // namespace furrow::render
