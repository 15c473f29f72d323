// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "render/compose/wrinkle_cache.h"
#include "render/gl/shader_library.h"
#include "render/scene/draw_list.h"
#include "render/scene/frame_block.h"
#include "render/scene/gpu_character.h"
#include "render/scene/lookup_tables.h"
#include "render/scene/posed_meshes.h"
#include "render/scene/scene_buffers.h"
#include "render/wrinkles/wrinkle_table.h"

namespace furrow::render {

// What the scene is drawn as: plain light in one target; lit by the skin pipeline; or the facets
// that it lights later (shaders/scene/scene.frag.glsl, skin/skin.frag.glsl, scene/surface.frag.glsl).
enum class SceneKind { kPlain, kSkin, kFacets };

// The posed subjects and the frame's lights on the GPU, and the draws that several passes make of
// them. A mesh is one draw call, however many subjects there are.
class SceneDraw {
 public:
  // Everything outlives it. `is_software`: a processor draws, for which composing wrinkles
  // beforehand pays even while they move (WrinkleCache).
  SceneDraw(const wrinkle::Skeleton& skeleton, std::span<const glm::mat4> inverse_bind_matrices,
            GpuCharacter* gpu, WrinkleTables* tables, ShaderLibrary* shaders, bool is_software);

  // Uploads what the request says, once a frame and before any pass draws; the request need not
  // outlive the call. Errors: of WrinkleTables::Update.
  [[nodiscard]] Status Update(const FrameRequest& request);
  [[nodiscard]] const FrameSetup& setup() const { return setup_; }
  // Metres that the surface may stand off its bounds in this frame.
  [[nodiscard]] float displacement_reach() const { return displacement_reach_; }

  // Binds what light is looked up in. `shadows`: the texture of all maps, 0: none.
  void BindTables(GLuint shadows);
  // The same and the frame's lights, for a pass that draws no mesh but lights its facets. The
  // shadow maps are bound as that pass reads them, to kShadowUnits.
  void BindLights(const Settings& settings);
  static constexpr std::array<GLuint, 2> kShadowUnits = {5, 6};
  // What skin/light.frag.glsl is compiled for.
  [[nodiscard]] static SceneShader LightShader(const Settings& settings);
  // A scene of these settings draws with textures that Compose() has to make first.
  [[nodiscard]] bool NeedsComposing(const Settings& settings) const;
  void Compose() { cache_.Compose(); }
  // Every mesh as lamp `light` sees it, into the bound framebuffer's viewport: depth alone.
  [[nodiscard]] Status DrawShadow(const Settings& settings, int light);
  // Every mesh in colour, for the settings' view, or its facets: into one target or five.
  [[nodiscard]] Status DrawScene(const Settings& settings, SceneKind kind);

 private:
  void PlanComposing(const FrameRequest& request);
  void FindVisible(std::span<const NamedSubject> subjects, const Settings& settings);
  void BindMasks();
  [[nodiscard]] WrinkleCache::Composed ComposedOf(int material, const Settings& settings) const;
  void BindMaterial(const GpuMaterial& material, const WrinkleCache::Composed& composed);
  // The material is bound, with the same part of its wrinkles.
  [[nodiscard]] Result<PosedMeshes::Vertices> Pose(std::size_t index, PosedMeshes::Form form,
                                                   WrinklePart part);
  [[nodiscard]] GpuMesh::Level LevelOf(std::size_t index, PosedMeshes::Form form, int level);
  // Everybody of whom the view sees the mesh, in one call.
  void DrawSubjects(const PosedMeshes::Vertices& posed, std::size_t index, PosedMeshes::Form form,
                    int view);
  [[nodiscard]] Status DrawCaster(const Settings& settings, int light, std::size_t index);
  void BindLookUps();
  [[nodiscard]] Status DrawMesh(const Settings& settings, SceneKind kind, std::size_t index);
  // What a program must know of the material and its wrinkles, whatever is made of them.
  [[nodiscard]] SceneShader SurfaceShader(const GpuMaterial& material,
                                          const WrinkleCache::Composed& composed) const;
  [[nodiscard]] SceneShader ShaderFor(const GpuMaterial& material,
                                      const WrinkleCache::Composed& composed,
                                      const Settings& settings, SceneKind kind) const;

  const wrinkle::Skeleton& skeleton_;
  std::span<const glm::mat4> inverse_bind_matrices_;
  GpuCharacter* gpu_;
  WrinkleTables* tables_;
  ShaderLibrary* shaders_;
  AmbientCache ambient_;
  FrameSetup setup_;
  float displacement_reach_ = 0.0f;
  bool is_crowd_ = false;
  DrawList draw_list_;
  SceneBuffers buffers_;
  WrinkleCache cache_;
  PosedMeshes posed_;

  LookupTables lookup_tables_;
  gl::Sampler shadow_compare_;
  gl::Sampler shadow_depth_;
  gl::Sampler cut_out_;
};

}  // namespace furrow::render
