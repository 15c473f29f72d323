// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "render/scene/gpu_character.h"
#include "render/scene/lighting.h"
#include "render/request/subjects.h"

namespace furrow::render {

// Which subjects' meshes the camera and the lamps of a frame can see at all.
class DrawList {
 public:
  static constexpr int kCamera = kNumLights;  // the views: the lamps, then the camera
  static constexpr int kNumViews = kNumLights + 1;
  struct View {
    glm::mat4 projection{1.0f};  // to clip space
    float pixels = 0.0f;         // of a metre where clip space's w is 1
    bool is_asked = true;        // a dark lamp's shadows are not
  };
  struct Tolerance {
    float reach = 0.0f;         // metres that surfaces may stand off their bounds
    float error_pixels = 0.0f;  // that a simplified mesh may be off by
    float hair_shadow = 0.0f;   // metres, hair as a caster of shadows
  };

  void Build(GpuCharacter* gpu, std::span<const NamedSubject> subjects,
             const std::array<View, kNumViews>& views, const Tolerance& tolerance);

  // The subjects of whom some view sees the mesh, in ascending order.
  [[nodiscard]] std::span<const std::uint32_t> subjects(std::size_t mesh) const {
    return meshes_[mesh].subjects;
  }
  // Of GpuMesh::levels, one each of subjects(). By the camera, or by the lamps where the camera
  // sees nothing. The same for all views, so that no surface throws the shadow of another on
  // itself; but lamps see hair coarser, within the tolerance: it has no smooth surface that would
  // show it.
  [[nodiscard]] std::span<const int> levels(int view, std::size_t mesh) const {
    return view == kCamera ? meshes_[mesh].levels : meshes_[mesh].shadow_levels;
  }
  // How large the camera sees a mesh, of all subjects.
  struct Sight {
    float pixels = 0.0f;   // of a metre of it where it is nearest; 0: nobody's is seen
    float covered = 0.0f;  // of the picture, at most: [0, 1] for one subject
  };
  [[nodiscard]] const Sight& sight(std::size_t mesh) const { return meshes_[mesh].sight; }
  // Those whom a view sees, as positions in subjects().
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
