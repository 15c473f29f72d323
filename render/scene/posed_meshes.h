// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "render/gl/shader_library.h"
#include "render/mesh/mesh_clusters.h"
#include "render/scene/gpu_character.h"
#include "render/scene/morph_sums.h"
#include "render/wrinkles/wrinkle_table.h"

namespace furrow::render {

// The vertices of a former picture with one subject, by mesh (an index of GpuCharacter::meshes()).
struct FormerVertices {
  struct Mesh {
    gl::Buffer vertices;
    std::size_t capacity = 0;  // bytes
    GLsizei count = 0;
    GLuint stride = 0;                // bytes
    int order = 0;                    // GpuMesh::order
    std::vector<ElementRange> known;  // the vertices that have been posed
  };
  std::map<std::size_t, Mesh> meshes;

  [[nodiscard]] std::size_t num_bytes() const;
};

// Skinned vertices of meshes for all subjects of a frame. They are computed once per frame and read
// by every pass that draws them: the scene and the shadow maps of all lamps.
class PosedMeshes {
 public:
  // How a mesh's vertices form triangles.
  enum class Form { kIndexed, kUnindexed, kPatches };
  static constexpr std::size_t kMaxVertices = std::size_t{1} << 24;  // per mesh, over all subjects

  // All arguments must outlive this object.
  PosedMeshes(GpuCharacter* gpu, MorphSums* morphs, ShaderLibrary* shaders)
      : gpu_(gpu), morphs_(morphs), shaders_(shaders) {}

  // Marks all posed vertices as outdated. `former`: vertices that the shaders compare with those of
  // this frame (a_former of scene.vert.glsl), and which must live until the frame ends; null: none.
  // A mesh that is missing there, or has another number of vertices, is compared with itself, and
  // so are vertices that `former` does not know; it receives them.
  void BeginFrame(FormerVertices* former);
  // Moves the vertices of this frame (kIndexed) to `former` in exchange for the buffers there.
  void EndFrame(FormerVertices* former);

  struct Vertices {
    GLuint vertex_array = 0;  // in the layout of scene.vert.glsl, one subject after another
    GLsizei per_subject = 0;
  };
  // Returns the vertices of mesh `mesh` (an index of GpuCharacter::meshes()) in the poses of
  // `subjects`, ascending numbers of the frame's subjects, at least one. With PoseShader::dynamic
  // they have dynamic masks for the maps of `part`. Repeated calls within a frame reuse the
  // vertices unless they ask for other masks. Requires that SceneBuffers has bound joints and
  // dynamic masks, and that MorphSums has this frame's weights; changes the current program.
  // `needed`: the vertices of a single subject that the frame needs, ascending; the others are
  // undefined. Empty: all. Errors: kLimit (kMaxVertices), kInternal (a shader).
  [[nodiscard]] Result<Vertices> Get(std::size_t mesh, Form form, const PoseShader& shader,
                                     WrinklePart part, std::span<const std::uint32_t> subjects,
                                     std::span<const ElementRange> needed = {});

 private:
  struct Posed {
    gl::VertexArray vertex_array;
    gl::Buffer vertices;
    std::size_t capacity = 0;  // of `vertices`, in bytes
    gl::Buffer subjects;       // one subject number per instance
    GLsizei per_subject = 0;
    GLuint stride = 0;                 // of `vertices`, in bytes
    std::vector<ElementRange> needed;  // the vertices that are posed
    std::optional<WrinklePart> masks;  // the part whose masks the vertices hold
    bool is_fresh = false;
  };
  struct Source {
    std::size_t mesh = 0;
    GLuint vertex_array = 0;
    GLsizei num_vertices = 0;
    GLuint indices = 0;  // 0: none
  };
  [[nodiscard]] Source SourceOf(std::size_t mesh, Form form);
  static void Reserve(std::size_t bytes, Posed* posed);
  [[nodiscard]] Status Pose(const Source& source, const PoseShader& shader,
                            std::span<const std::uint32_t> subjects, Posed* posed);

  void DescribeFormer(const Source& source, const Posed& posed);
  void Capture(const Source& source, const PoseShader& shader,
               std::span<const std::uint32_t> subjects, const Posed& posed);

  GpuCharacter* gpu_;
  MorphSums* morphs_;
  ShaderLibrary* shaders_;
  std::map<std::pair<std::size_t, Form>, Posed> posed_;
  FormerVertices* former_ = nullptr;
};

}  // namespace furrow::render
