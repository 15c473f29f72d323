// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "render/compose/wrinkle_cache.h"
#include "render/gl/shader_library.h"
#include "render/scene/draw_list.h"
#include "render/scene/frame_block.h"
#include "render/scene/gpu_character.h"
#include "render/scene/lookup_tables.h"
#include "render/scene/material_blocks.h"
#include "render/scene/morph_sums.h"
#include "render/scene/motion.h"
#include "render/scene/posed_meshes.h"
#include "render/scene/scene_buffers.h"
#include "render/wrinkles/wrinkle_table.h"

namespace furrow::render {

// How the scene is drawn: with plain light into one target (shaders/scene/scene.frag.glsl), lit by
// the skin pipeline (skin/skin.frag.glsl), or as facets that the skin pipeline lights later
// (scene/surface.frag.glsl).
enum class SceneKind { kPlain, kSkin, kFacets };

// Holds the posed subjects and the frame's lights on the GPU, and draws them for several passes.
// Each mesh is one draw call, whatever the number of
// subjects, unless their shapes change its material.
class SceneDraw {
 public:
  // All arguments must outlive this object. `is_software`: the driver renders on the CPU, where
  // composing wrinkles in advance pays even while they move (WrinkleCache), and so does drawing the
  // depth of cut-outs first.
  SceneDraw(const wrinkle::Skeleton& skeleton, std::span<const glm::mat4> inverse_bind_matrices,
            GpuCharacter* gpu, WrinkleTables* tables, ShaderLibrary* shaders, bool is_software);

  // Uploads a request. Call once per frame, before any pass draws. The request may be freed
  // afterwards. `motion`: for kFacets of a single subject without displacement; what it refers to
  // must live until the frame ends. Null: the picture stands alone. Errors: those of
  // WrinkleTables::Update().
  [[nodiscard]] Status Update(const FrameRequest& request, const SceneMotion* motion = nullptr);
  // Keeps the posed vertices of this frame for the next picture of its stream. Call it when the
  // frame has been drawn.
  void KeepVertices(FormerVertices* former) { posed_.EndFrame(former); }
  // Where the camera sees the subject, or its skin alone; null: not known closely.
  [[nodiscard]] const JointBounds::Extent* seen_extent(bool skin_only) const {
    return draw_list_.seen_extent(skin_only);
  }
  // The camera of the former picture if this frame uses its shadow maps, otherwise null.
  [[nodiscard]] const CameraFrame* shadow_camera() const {
    return shadow_camera_.has_value() ? &*shadow_camera_ : nullptr;
  }
  // True if this frame has motion: kFacets has one more target, the last.
  [[nodiscard]] bool has_motion() const { return has_motion_; }
  [[nodiscard]] const FrameSetup& setup() const { return setup_; }
  // Upper bound, in metres, of the distance between the drawn and the skinned surface in this
  // frame.
  [[nodiscard]] float displacement_reach() const { return displacement_reach_; }

  // Binds the look-up tables of the lighting. `shadows`: texture of all shadow maps; 0: none.
  void BindTables(GLuint shadows);
  // Binds the look-up tables and the frame's lights for a pass that lights stored facets. That pass
  // binds the shadow maps to kShadowUnits itself.
  void BindLights(const Settings& settings);
  static constexpr std::array<GLuint, 2> kShadowUnits = {5, 6};
  // The switches for skin/light.frag.glsl.
  [[nodiscard]] static SceneShader LightShader(const Settings& settings);
  // Returns true if Compose() must run before a scene with these settings is drawn.
  [[nodiscard]] bool NeedsComposing(const Settings& settings) const;
  // Paints the wrinkles that WrinkleCache composes into textures.
  void Compose() { cache_.Compose(); }
  // Draws the depth of every mesh as lamp `light`, in [0, kNumLights), sees it, into the viewport
  // of the bound framebuffer. Errors: those of ShaderLibrary and PosedMeshes.
  [[nodiscard]] Status DrawShadow(const Settings& settings, int light);
  // Appends numbers that state which parts of the meshes lamp `light` sees.
  void AppendCasters(int light, std::vector<float>* values) const;
  // True if the character sends out light, so that kFacets has a sixth target.
  [[nodiscard]] bool emits() const { return gpu_->emits(); }
  // Draws every mesh for settings.view into the bound framebuffer, which has one target for kPlain
  // and five for the other kinds. Errors: those of ShaderLibrary and PosedMeshes.
  [[nodiscard]] Status DrawScene(const Settings& settings, SceneKind kind);

 private:
  void PlanComposing(const FrameRequest& request);
  // `turns`: the camera of a stream moves.
  void FindVisible(std::span<const NamedSubject> subjects, const Settings& settings, bool turns);
  void BindMasks();
  [[nodiscard]] WrinkleCache::Composed ComposedOf(int material, const Settings& settings) const;
  void BindMaterial(const GpuMaterial& material, const WrinkleCache::Composed& composed);
  // Requires a bound material with the same part of its wrinkles.
  [[nodiscard]] Result<PosedMeshes::Vertices> Pose(std::size_t index, PosedMeshes::Form form,
                                                   WrinklePart part);
  [[nodiscard]] GpuMesh::Level LevelOf(std::size_t index, PosedMeshes::Form form, int level);
  // Draws all subjects that the view sees of the mesh: in one call, or in one per look of the
  // material if shapes change it.
  void DrawSubjects(const PosedMeshes::Vertices& posed, std::size_t index, PosedMeshes::Form form,
                    int view);
  void DrawAlike(const PosedMeshes::Vertices& posed, std::size_t index, PosedMeshes::Form form,
                 int view, std::span<const std::uint32_t> seen);
  [[nodiscard]] Status DrawCaster(const Settings& settings, int light, std::size_t index);
  void BindLookUps();
  [[nodiscard]] Status DrawMesh(const Settings& settings, SceneKind kind, std::size_t index);
  [[nodiscard]] Status DrawCutOutDepth(const PosedMeshes::Vertices& posed, std::size_t index,
                                       PosedMeshes::Form form);
  // The switches that depend on the material and its wrinkles only.
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
  const bool is_software_;
  AmbientCache ambient_;
  FrameSetup setup_;
  float displacement_reach_ = 0.0f;
  float hair_pixels_ = 0.0f;  // DrawList::Tolerance::hair_pixels
  std::optional<CameraFrame> shadow_camera_;
  bool is_crowd_ = false;
  bool has_motion_ = false;
  DrawList draw_list_;
  SceneBuffers buffers_;
  WrinkleCache cache_;
  MorphSums morphs_;
  MaterialBlocks materials_;
  PosedMeshes posed_;

  LookupTables lookup_tables_;
  gl::Sampler shadow_compare_;
  gl::Sampler shadow_depth_;
  gl::Sampler cut_out_;
};

}  // namespace furrow::render
