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

// Selects the subjects of each mesh that the camera and the lamps can see, their level of detail,
// and the parts of a single subject's meshes. A lamp sees what may cast a shadow on a surface that
// the camera sees.
class DrawList {
 public:
  static constexpr int kCamera = kNumLights;  // index of the camera's view; the lamps' views come
                                              // first
  static constexpr int kNumViews = kNumLights + 1;
  struct View {
    glm::mat4 projection{1.0f};  // model space to clip space
    float pixels = 0.0f;         // pixels per metre where clip space's w is 1
    bool is_active = true;       // false: a lamp that casts no shadow
    // How far beyond the part that matters a surface counts, in normalised device coordinates: the
    // first at any distance, the second where clip space's w is 1.
    float margin = 0.0f;
    float margin_at_1 = 0.0f;
  };
  struct Tolerance {
    float reach = 0.0f;         // metres between the drawn and the skinned surface, at most
    float error_pixels = 0.0f;  // allowed RMS error of simplified meshes, picture pixels
    float hair_pixels = 0.0f;   // allowed RMS error of hair in the picture, picture pixels
    float hair_shadow = 0.0f;   // allowed RMS error of hair in shadow maps, metres
    bool all_casters = false;   // also those whose shadows the camera does not see
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
  // The parts of a mesh that a picture needs. Only a picture of one subject without displacement
  // has any.
  struct Parts {
    // The triangles that each view sees at level 0, as ranges of the mesh's indices.
    std::array<std::vector<ElementRange>, kNumViews> indices;
    std::vector<ElementRange> vertices;  // those that some view needs
  };
  // Null: the picture needs the whole mesh.
  [[nodiscard]] const Parts* parts(std::size_t mesh) const {
    return has_parts_ ? &meshes_[mesh].parts : nullptr;
  }
  // Where the parts that the camera sees are, of all meshes or of skin alone. Null: the picture
  // needs whole meshes. Without parts, `low` is above `high`.
  [[nodiscard]] const JointBounds::Extent* seen_extent(bool skin_only) const {
    return has_parts_ ? &extents_[skin_only ? 1 : 0] : nullptr;
  }

 private:
  struct Mesh {
    std::vector<std::uint32_t> subjects;
    std::vector<int> levels;
    std::vector<int> shadow_levels;
    Sight sight;
    std::array<std::vector<std::uint32_t>, kNumViews> seen;
    std::array<std::vector<std::uint32_t>, kNumViews> clusters;  // seen; of GpuMesh::clusters
    std::vector<float> reaches;  // MeshCluster::MorphReach() of each of GpuMesh::clusters
    Parts parts;
  };
  using Views = std::array<View, kNumViews>;
  struct Rect;
  void FindParts(const GpuCharacter& gpu, const PosedSubject& subject, const Views& views,
                 bool all_casters);
  void FindParts(const GpuCharacter& gpu, const PosedSubject& subject, const Views& views, int view,
                 const Rect& rect);
  [[nodiscard]] Rect Shaded(const GpuCharacter& gpu, const PosedSubject& subject,
                            const View& lamp) const;
  void FindReaches(const GpuCharacter& gpu, const PosedSubject& subject);
  [[nodiscard]] std::array<JointBounds::Extent, 2> Extents(const GpuCharacter& gpu,
                                                           const PosedSubject& subject,
                                                           const View& view) const;
  void FindVertices(const GpuCharacter& gpu);

  std::vector<Mesh> meshes_;
  bool has_parts_ = false;
  std::array<JointBounds::Extent, 2> extents_;  // see seen_extent()
};

}  // namespace furrow::render
