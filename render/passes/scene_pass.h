// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/camera.h"
#include "render/frame_graph.h"
#include "render/gl_device.h"
#include "render/gpu_character.h"
#include "render/shader_library.h"
#include "render/wrinkle_table.h"

namespace furrow::render {

// Draws the posed character: skinning, wrinkle normals, three lights. Declares a colour target
// (linear; what it holds depends on the view, see shaders/README.md) and a depth target of its own.
class ScenePass {
 public:
  struct Targets {
    int width = 0;
    int height = 0;
    PixelFormat format = PixelFormat::kRgba16F;
    int samples = 4;
  };

  // Everything outlives the pass.
  ScenePass(const wrinkle::Skeleton& skeleton, std::span<const glm::mat4> inverse_bind_matrices,
            GpuCharacter* gpu, WrinkleTables* tables, ShaderLibrary* shaders, GlDevice* device);

  // Uploads what the request says and adds the pass; returns the colour written. The request need
  // not outlive the call. Errors: of WrinkleTables::Update.
  [[nodiscard]] Result<FrameGraph::Handle> Add(FrameGraph* graph, const FrameRequest& request,
                                               const Targets& targets);

 private:
  void UploadFrame(const FrameRequest& request);
  void UploadJoints(std::span<const glm::mat4> model);
  void UploadWrinkles();
  [[nodiscard]] Status Draw(const Settings& settings, GLuint framebuffer,
                            const TextureDesc& target);
  [[nodiscard]] Status DrawMesh(const Settings& settings, std::size_t index);
  [[nodiscard]] SceneShader ShaderFor(const GpuMaterial& material, const Settings& settings) const;

  const wrinkle::Skeleton& skeleton_;
  std::span<const glm::mat4> inverse_bind_matrices_;
  GpuCharacter* gpu_;
  WrinkleTables* tables_;
  ShaderLibrary* shaders_;
  GlDevice* device_;

  gl::Buffer frame_;
  gl::Buffer joints_;
  gl::Buffer wrinkle_tables_[kNumWrinkleGroups];
  gl::Buffer influences_;
  gl::Buffer palettes_[kNumWrinkleGroups + 1];  // by group, kNone included
};

}  // namespace furrow::render
