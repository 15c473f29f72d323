// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "render/frame_block.h"
#include "render/gpu_character.h"
#include "render/lookup_tables.h"
#include "render/shader_library.h"
#include "render/wrinkle_table.h"

namespace furrow::render {

// The posed character and the frame's lights as buffers on the GPU, and the draws that several
// passes make of them.
class SceneDraw {
 public:
  // Everything outlives it.
  SceneDraw(const wrinkle::Skeleton& skeleton, std::span<const glm::mat4> inverse_bind_matrices,
            GpuCharacter* gpu, WrinkleTables* tables, ShaderLibrary* shaders);

  // Uploads what the request says, once a frame and before any pass draws; the request need not
  // outlive the call. Errors: of WrinkleTables::Update.
  [[nodiscard]] Status Update(const FrameRequest& request);
  [[nodiscard]] const FrameSetup& setup() const { return setup_; }
  // Metres that the surface may stand off its bounds in this frame.
  [[nodiscard]] float displacement_reach() const { return displacement_reach_; }

  // Binds what the skin pipeline's scene looks up. `shadows`: the texture of all maps, 0: none.
  void BindTables(GLuint shadows);
  // Every mesh as lamp `light` sees it, into the bound framebuffer's viewport: depth alone.
  [[nodiscard]] Status DrawShadow(const Settings& settings, int light);
  // Every mesh in colour, for the settings' view; with skin shading, into its five targets.
  [[nodiscard]] Status DrawScene(const Settings& settings, Shading shading);

 private:
  // Which meshes the camera and the lamps can see at all.
  void FindVisible(std::span<const glm::mat4> model);
  void UploadFrame(const Settings& settings);
  void UploadJoints(std::span<const glm::mat4> model);
  void UploadWrinkles();
  void BindBuffers();
  void BindMasks();
  void BindMaterial(const GpuMaterial& material);
  void DrawTriangles(const SceneShader& shader, std::size_t index);
  [[nodiscard]] Status DrawMesh(const Settings& settings, Shading shading, std::size_t index);
  [[nodiscard]] bool IsDisplaced(const GpuMaterial& material, const Settings& settings) const;
  // What a program must know of the material and its wrinkles, whatever is made of them.
  [[nodiscard]] SceneShader SurfaceShader(const GpuMaterial& material) const;
  [[nodiscard]] SceneShader ShaderFor(const GpuMaterial& material, const Settings& settings,
                                      Shading shading) const;

  const wrinkle::Skeleton& skeleton_;
  std::span<const glm::mat4> inverse_bind_matrices_;
  GpuCharacter* gpu_;
  WrinkleTables* tables_;
  ShaderLibrary* shaders_;
  AmbientCache ambient_;
  FrameSetup setup_;
  float displacement_reach_ = 0.0f;
  std::vector<bool> seen_;                           // a mesh each: by the camera
  std::array<std::vector<bool>, kNumLights> casts_;  // by a lamp

  LookupTables lookup_tables_;
  gl::Sampler shadow_compare_;
  gl::Sampler shadow_depth_;
  gl::Sampler cut_out_;
  gl::Buffer frame_;
  gl::Buffer joints_;
  gl::Buffer wrinkle_tables_[kNumWrinkleGroups];
  gl::Buffer dynamic_masks_[kNumWrinkleGroups];
  gl::Buffer influences_;
  gl::Buffer palettes_[kNumWrinkleGroups + 1];  // by group, kNone included
};

}  // namespace furrow::render
