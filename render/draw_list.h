// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "render/gpu_mesh.h"
#include "render/lighting.h"
#include "render/subjects.h"

namespace furrow::render {

// Which subjects' meshes the camera and the lamps of a frame can see at all.
class DrawList {
 public:
  static constexpr int kCamera = kNumLights;  // the views: the lamps, then the camera
  static constexpr int kNumViews = kNumLights + 1;
  struct View {
    glm::mat4 projection{1.0f};  // to clip space
    bool is_asked = true;        // a dark lamp's shadows are not
  };

  // `reach`: metres that surfaces may stand off their bounds.
  void Build(std::span<const GpuMesh> meshes, std::span<const NamedSubject> subjects,
             const std::array<View, kNumViews>& views, float reach);

  // The subjects of whom some view sees the mesh, in ascending order.
  [[nodiscard]] std::span<const std::uint32_t> subjects(std::size_t mesh) const {
    return meshes_[mesh].subjects;
  }
  // Those whom a view sees, as positions in subjects().
  [[nodiscard]] std::span<const std::uint32_t> seen(int view, std::size_t mesh) const {
    return meshes_[mesh].seen[static_cast<std::size_t>(view)];
  }

 private:
  struct Mesh {
    std::vector<std::uint32_t> subjects;
    std::array<std::vector<std::uint32_t>, kNumViews> seen;
  };
  std::vector<Mesh> meshes_;
};

}  // namespace furrow::render
