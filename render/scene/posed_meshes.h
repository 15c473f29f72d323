// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "render/gl/shader_library.h"
#include "render/scene/gpu_character.h"
#include "render/wrinkles/wrinkle_table.h"

namespace furrow::render {

// The vertices of meshes in the poses of a frame's subjects, worked out once a frame and read by
// every pass that draws them: scene and shadow maps of all lamps alike.
class PosedMeshes {
 public:
  // How a mesh's triangles are put together.
  enum class Form { kIndexed, kUnindexed, kPatches };
  static constexpr std::size_t kMaxVertices = std::size_t{1} << 24;  // of a mesh, all subjects

  PosedMeshes(GpuCharacter* gpu, ShaderLibrary* shaders) : gpu_(gpu), shaders_(shaders) {}

  // What was posed belongs to the last frame.
  void BeginFrame();

  struct Vertices {
    GLuint vertex_array = 0;  // as shaders/scene/scene.vert.glsl reads it, one subject after the other
    GLsizei per_subject = 0;
  };
  // A mesh in the poses of `subjects`, of whom there is at least one. Joints and dynamic masks are
  // bound; leaves its own program in use. PoseShader::dynamic: with the dynamic masks of each
  // vertex, of the maps of `part`. Posed anew in a frame only where calls ask for different ones.
  // Errors: kLimit (kMaxVertices), kInternal (a shader).
  [[nodiscard]] Result<Vertices> Get(std::size_t mesh, Form form, const PoseShader& shader,
                                     WrinklePart part, std::span<const std::uint32_t> subjects);

 private:
  struct Posed {
    gl::VertexArray vertex_array;
    gl::Buffer vertices;
    std::size_t capacity = 0;  // of `vertices`, bytes
    gl::Buffer subjects;       // one an instance
    GLsizei per_subject = 0;
    std::optional<WrinklePart> masks;  // that the vertices bring
    bool is_fresh = false;
  };
  struct Source {
    GLuint vertex_array = 0;
    GLsizei num_vertices = 0;
    GLuint indices = 0;  // 0: none
  };
  [[nodiscard]] Source SourceOf(std::size_t mesh, Form form);
  static void Reserve(std::size_t bytes, Posed* posed);
  [[nodiscard]] Status Pose(const Source& source, const PoseShader& shader,
                            std::span<const std::uint32_t> subjects, Posed* posed);

  GpuCharacter* gpu_;
  ShaderLibrary* shaders_;
  std::map<std::pair<std::size_t, Form>, Posed> posed_;
};

}  // namespace furrow::render
