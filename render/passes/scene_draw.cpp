// SPDX-License-Identifier: Apache-2.0
#include "render/passes/scene_draw.h"

#include <algorithm>

#include <glm/gtc/matrix_transform.hpp>

#include "base/status.h"
#include "render/mesh/displacement_patches.h"

namespace furrow::render {
namespace {

// Binding points of the shaders in scene/, skin/ and wrinkles/. See also scene_buffers.cpp, which
// has texture unit 13.
constexpr GLuint kMaterialBlock = 1;
enum TextureUnit : GLuint {
  kBaseColourUnit = 0,
  kBaseDerivativesUnit = 1,
  kMasksUnit = 2,
  kWrinkleDerivativesUnit = 3,
  kRoughnessUnit = 4,
  kBeckmannUnit = 7,
  kSpecularAlbedoUnit = 8,
  kPreintegratedUnit = 9,
  kWrinkleLooksUnit = 10,
  kThicknessUnit = 11,
  kWrinkleHeightsUnit = 12,
  kEmissionUnit = 14
};
// Normalised device coordinates: the jitter of a small picture, and rounding.
constexpr float kCameraMargin = 0.1f;
// How far a look-up of a shadow map is from the surface (shaders/shadow/shadow.glsl): a few texels,
// and metres, the largest radius of the filter and the way along the normal.
constexpr float kShadowMargin = 0.03f;
constexpr float kShadowRadius = 0.05f;
constexpr float kShadowOffset = 0.01f;
constexpr float kMetresPerMm = 0.001f;
// Allowed RMS error of hair in moving pictures, drawn pixels.
constexpr float kMovingHairPixels = 0.5f;
constexpr GLint kLightLocation = 0;        // of shadow.vert.glsl and displace.tese.glsl
constexpr GLint kHeightTexelLocation = 1;  // of displace.tese.glsl

// Culling is state of the context, so every draw sets it. Cloth and hair cards may be double-sided.
void SetCulling(bool cull) {
  if (cull) {
    glEnable(GL_CULL_FACE);
  } else {
    glDisable(GL_CULL_FACE);
  }
}

// With `compare`, each look-up returns the share of four texels that the lamp reaches. Without, it
// returns a depth, which must not be filtered: the mean of two surfaces' depths lies on neither.
gl::Sampler MakeShadowSampler(bool compare) {
  gl::Sampler sampler = gl::MakeSampler();
  const GLint filter = compare ? GL_LINEAR : GL_NEAREST;
  glSamplerParameteri(sampler.name(), GL_TEXTURE_MIN_FILTER, filter);
  glSamplerParameteri(sampler.name(), GL_TEXTURE_MAG_FILTER, filter);
  glSamplerParameteri(sampler.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glSamplerParameteri(sampler.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  if (compare) {
    glSamplerParameteri(sampler.name(), GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glSamplerParameteri(sampler.name(), GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  }
  return sampler;
}

// For cut-outs in shadow maps. One texel is precise enough there.
gl::Sampler MakeCutOutSampler() {
  gl::Sampler sampler = gl::MakeSampler();
  glSamplerParameteri(sampler.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
  glSamplerParameteri(sampler.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return sampler;
}

// Sets how a mesh is drawn over others. A shade multiplies what the targets hold (shade.frag.glsl)
// and leaves the depth of the surface behind it.
void SetShade(bool shade) {
  glDepthMask(shade ? GL_FALSE : GL_TRUE);
  if (shade) {
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_ZERO, GL_SRC_COLOR, GL_ZERO, GL_SRC_ALPHA);
  } else {
    glDisable(GL_BLEND);
  }
}

// Sets whether only those fragments are drawn that DrawCutOutDepth() has left.
void SetBehindCutOut(bool behind) {
  glDepthFunc(behind ? GL_EQUAL : GL_LESS);
  glDepthMask(behind ? GL_FALSE : GL_TRUE);
}

// Returns true if a view shows light, which a shade darkens. Other views show data.
bool ShowsShade(const Settings& settings) {
  return settings.view == View::kFinal || settings.view == View::kSpecular ||
         settings.view == View::kBloom;
}

// Returns true if a view can use composed wrinkles. Views that show masks or weights need each
// wrinkle separately, and the tangent-space blend cannot be composed in advance.
bool TakesComposed(const Settings& settings, View view) {
  return settings.wrinkle_maps.cache && view != View::kWeights && view != View::kMaskDynamic &&
         view != View::kMaskTexture && settings.normal_blend == NormalBlend::kPartialDerivative;
}

// Metres from a surface to the farthest texel that its look-up of a shadow map may use.
float ShadowReach(const Settings& settings) {
  const ShadowSettings& shadow = settings.shadow;
  const float filter = shadow.filter == ShadowFilter::kPcf
                           ? 1.5f * kMetresPerMm * shadow.softness_mm
                           : std::max(kShadowRadius, kMetresPerMm * shadow.lamp_mm);
  return filter + kShadowOffset + kMetresPerMm * shadow.normal_offset_mm +
         kMetresPerMm * settings.translucency.shrink_mm;
}

// Returns true if some view needs shadow maps.
bool HasShadows(const Settings& settings) {
  return settings.shadow.filter != ShadowFilter::kOff &&
         AnyView(settings, [&](View view) { return NeedsSkinPipeline(view, settings); });
}

// The same for the picture's view or any view of its strip.
bool SomeViewTakesComposed(const Settings& settings) {
  return AnyView(settings, [&](View view) { return TakesComposed(settings, view); });
}

// The view for which the skin pipeline's shaders are compiled. Views of later stages use kFinal.
View SkinView(View view) {
  switch (view) {
    case View::kShadow:
    case View::kSpecular:
    case View::kTranslucency:
    case View::kAlbedo:
    case View::kMaterial: return view;
    default: return View::kFinal;
  }
}

// Translucency takes the thickness from shadow maps, so it needs them.
bool CanShineThrough(const Settings& settings) {
  return settings.translucency.enabled && settings.shadow.filter != ShadowFilter::kOff;
}

// Sets the lighting switches. `skin`: the surface may be skin.
void AddLight(const Settings& settings, bool skin, SceneShader* shader) {
  shader->view = SkinView(settings.view);
  shader->shadow_filter = settings.shadow.filter;
  shader->shadow_lamps = settings.shadow.filter == ShadowFilter::kOff ? 0 : settings.shadow.lamps;
  shader->shadow_taps = settings.shadow.taps;
  shader->translucency = skin && CanShineThrough(settings);
  shader->preintegrated = skin && settings.subsurface.method == SubsurfaceMethod::kPreintegrated;
  shader->beckmann_table = settings.specular.table;
  shader->gems = settings.specular.mode == SpecularMode::kGems;
  shader->conserve_energy = settings.specular.conserve_energy;
}

}  // namespace

SceneDraw::SceneDraw(const wrinkle::Skeleton& skeleton,
                     std::span<const glm::mat4> inverse_bind_matrices, GpuCharacter* gpu,
                     WrinkleTables* tables, ShaderLibrary* shaders, bool is_software)
    : skeleton_(skeleton),
      inverse_bind_matrices_(inverse_bind_matrices),
      gpu_(gpu),
      tables_(tables),
      shaders_(shaders),
      is_software_(is_software),
      buffers_(inverse_bind_matrices, tables),
      cache_(gpu, tables, inverse_bind_matrices, is_software),
      morphs_(gpu),
      materials_(gpu),
      posed_(gpu, &morphs_, shaders),
      shadow_compare_(MakeShadowSampler(true)),
      shadow_depth_(MakeShadowSampler(false)),
      cut_out_(MakeCutOutSampler()) {}

Status SceneDraw::Update(const FrameRequest& request, const SceneMotion* motion) {
  FURROW_RETURN_IF_ERROR(tables_->Update(request));
  setup_ = SetUpFrame(request, skeleton_, &ambient_);
  shadow_camera_.reset();
  if (motion != nullptr && motion->shadows != nullptr) {
    shadow_camera_ = *motion->camera;
    setup_.shadows = motion->shadows->views;
    setup_.shadow_resolution = motion->shadows->resolution;
  }
  const Settings& settings = request.settings;
  // Bounds of the skinned surface must be enlarged by the highest possible fold. The height map's
  // unit is millimetres.
  displacement_reach_ = settings.displacement.enabled
                            ? 0.001f * settings.displacement.strength * settings.wrinkle_strength *
                                  gpu_->heights().max_mm
                            : 0.0f;
  const std::vector<NamedSubject> subjects = SubjectsOf(request);
  is_crowd_ = subjects.size() > 1;
  hair_pixels_ = request.is_moving ? kMovingHairPixels / request.scale : 0.0f;
  // Later steps use the results of earlier ones: tables, frame set-up, visibility, composing.
  // The next picture of a stream may use this one's shadow maps, and a camera that turns sees more.
  const bool turns = motion != nullptr && motion->camera != nullptr &&
                     motion->camera->view_projection != setup_.camera.view_projection;
  FindVisible(subjects, settings, turns);
  has_motion_ = motion != nullptr;
  FrameBlock frame = MakeFrameBlock(setup_, settings);
  if (has_motion_) {
    frame.view_projection =
        glm::translate(glm::mat4(1.0f), glm::vec3(motion->jitter, 0.0f)) * frame.view_projection;
    const CameraFrame& before = motion->camera == nullptr ? setup_.camera : *motion->camera;
    buffers_.UploadMotion({setup_.camera.view_projection, before.view_projection,
                           FocusPlane(before), glm::vec4(motion->detail, 0.0f, 0.0f, 0.0f)});
  }
  buffers_.Upload(frame, subjects, gpu_->layout());
  morphs_.BeginFrame(subjects);
  materials_.BeginFrame(subjects);
  posed_.BeginFrame(has_motion_ ? motion->vertices : nullptr);
  PlanComposing(request);
  return {};
}

// A composed texture shows one subject's weights, so crowds evaluate wrinkles per fragment.
void SceneDraw::PlanComposing(const FrameRequest& request) {
  if (is_crowd_ || !SomeViewTakesComposed(request.settings)) return cache_.Disable();
  cache_.Plan(request.settings,
              {.subject = &request,
               .projection = setup_.camera.view_projection,
               .pixels = setup_.pixels_per_slope,
               .reach = gpu_->MorphReach(request.shapes),
               .picture = static_cast<float>(request.width) * static_cast<float>(request.height),
               .list = &draw_list_});
}

void SceneDraw::FindVisible(std::span<const NamedSubject> subjects, const Settings& settings,
                            bool turns) {
  std::array<DrawList::View, DrawList::kNumViews> views;
  views[DrawList::kCamera].projection = setup_.camera.view_projection;
  views[DrawList::kCamera].pixels = setup_.pixels_per_slope;
  views[DrawList::kCamera].margin = kCameraMargin;
  const bool casts = HasShadows(settings) && !shadow_camera_.has_value();
  for (int light = 0; light < kNumLights; ++light) {
    views[light].projection = FlatProjection(setup_.shadows[light]);
    views[light].pixels =
        0.5f * static_cast<float>(setup_.shadow_resolution) * setup_.shadows[light].scale;
    // A dark lamp needs no shadow map.
    views[light].is_active = casts && light < settings.shadow.lamps &&
                             setup_.lighting.lights[light].radiance != glm::vec3(0.0f);
    views[light].margin = kShadowMargin;
    views[light].margin_at_1 = setup_.shadows[light].scale * ShadowReach(settings);
  }
  draw_list_.Build(gpu_, subjects, views,
                   {.reach = displacement_reach_,
                    .error_pixels = is_crowd_ ? settings.detail.error_pixels : 0.0f,
                    .hair_pixels = hair_pixels_,
                    .hair_shadow = setup_.hair_shadow_error,
                    .all_casters = turns || AnyView(settings, [](View view) {
                                     return view == View::kShadowMaps;
                                   })});
}

void SceneDraw::BindMasks() {
  glBindTextureUnit(kMasksUnit, gpu_->masks());
  glBindTextureUnit(kWrinkleHeightsUnit, gpu_->heights().texture.name());
}

WrinkleCache::Composed SceneDraw::ComposedOf(int material, const Settings& settings) const {
  return TakesComposed(settings, settings.view) ? cache_.Find(material) : WrinkleCache::Composed();
}

bool SceneDraw::NeedsComposing(const Settings& settings) const {
  return TakesComposed(settings, settings.view) && cache_.is_stale();
}

void SceneDraw::BindMaterial(const GpuMaterial& material, const WrinkleCache::Composed& composed) {
  const ComposedMaterial::Textures& textures = composed.textures;
  buffers_.BindWrinkles(material.group, composed.rest);
  glBindTextureUnit(kBaseColourUnit, textures.colour != 0 ? textures.colour : material.base_colour);
  glBindTextureUnit(kBaseDerivativesUnit,
                    textures.derivatives != 0 ? textures.derivatives : material.derivatives);
  glBindTextureUnit(kRoughnessUnit, material.roughness);
  glBindTextureUnit(kThicknessUnit, material.thickness);
  glBindTextureUnit(kEmissionUnit, material.emission);
}

void SceneDraw::BindTables(GLuint shadows) {
  for (const GLuint unit : kShadowUnits) glBindTextureUnit(unit, shadows);
  BindLookUps();
}

void SceneDraw::BindLights(const Settings& settings) {
  buffers_.Bind();
  BindLookUps();
  if (settings.subsurface.method == SubsurfaceMethod::kPreintegrated) {
    glBindTextureUnit(kPreintegratedUnit, lookup_tables_.preintegrated());
  }
}

// One texture of shadow maps is bound to two units, because a sampler either compares or returns
// depth.
void SceneDraw::BindLookUps() {
  glBindSampler(kShadowUnits[0], shadow_compare_.name());
  glBindSampler(kShadowUnits[1], shadow_depth_.name());
  glBindTextureUnit(kBeckmannUnit, lookup_tables_.beckmann());
  glBindTextureUnit(kSpecularAlbedoUnit, lookup_tables_.specular_albedo());
}

Result<PosedMeshes::Vertices> SceneDraw::Pose(std::size_t index, PosedMeshes::Form form,
                                              WrinklePart part) {
  const GpuMaterial& material = gpu_->material(gpu_->meshes()[index].material);
  PoseShader shader;
  shader.num_joints = static_cast<int>(inverse_bind_matrices_.size());
  shader.displaced = form == PosedMeshes::Form::kPatches;
  shader.dynamic = material.group != WrinkleGroup::kNone &&
                   NeedsOf(tables_->table(material.group), part).uses_dynamic;
  shader.map_slots = MapSlots(tables_->num_maps());
  shader.gradients = static_cast<bool>(gpu_->meshes()[index].gradients);
  if (morphs_.Moves(index, draw_list_.subjects(index))) {
    shader.morph_parts = static_cast<int>(gpu_->meshes()[index].morphs.num_parts());
  }
  const DrawList::Parts* parts =
      form == PosedMeshes::Form::kIndexed ? draw_list_.parts(index) : nullptr;
  return posed_.Get(index, form, shader, part, draw_list_.subjects(index),
                    parts == nullptr ? std::span<const ElementRange>() : parts->vertices);
}

void SceneDraw::DrawSubjects(const PosedMeshes::Vertices& posed, std::size_t index,
                             PosedMeshes::Form form, int view) {
  glBindVertexArray(posed.vertex_array);
  if (form == PosedMeshes::Form::kPatches) {
    glUniform1f(kHeightTexelLocation,
                gpu_->Patches(index).metres_per_uv / static_cast<float>(gpu_->heights().side));
    glPatchParameteri(GL_PATCH_VERTICES, DisplacementPatches::kCorners);
  }
  for (const MaterialBlocks::Group& group :
       materials_.GroupsOf(gpu_->meshes()[index].material, draw_list_.subjects(index),
                           draw_list_.seen(view, index))) {
    glBindBufferBase(GL_UNIFORM_BUFFER, kMaterialBlock, group.block);
    DrawAlike(posed, index, form, view, group.seen);
  }
}

// The posed vertices of all subjects lie one after another in one buffer. Each subject is one entry
// of a multi-draw with its own base vertex and its own level of detail.
void SceneDraw::DrawAlike(const PosedMeshes::Vertices& posed, std::size_t index,
                          PosedMeshes::Form form, int view, std::span<const std::uint32_t> seen) {
  std::vector<GLint> first(seen.size());  // first vertex of each subject
  std::ranges::transform(seen, first.begin(), [&](std::uint32_t subject) {
    return static_cast<GLint>(subject) * posed.per_subject;
  });
  if (form == PosedMeshes::Form::kUnindexed) {
    const std::vector<GLsizei> counts(seen.size(), gpu_->meshes()[index].num_indices);
    glMultiDrawArrays(GL_TRIANGLES, first.data(), counts.data(), static_cast<GLsizei>(seen.size()));
    return;
  }
  std::vector<GLsizei> counts;
  std::vector<const void*> offsets;
  const auto add = [&](std::size_t first_index, std::size_t count) {
    counts.push_back(static_cast<GLsizei>(count));
    offsets.push_back(reinterpret_cast<const void*>(std::uintptr_t{4} * first_index));
  };
  const DrawList::Parts* parts =
      form == PosedMeshes::Form::kIndexed ? draw_list_.parts(index) : nullptr;
  if (parts != nullptr && draw_list_.levels(view, index)[0] == 0) {
    for (const ElementRange& range : parts->indices[static_cast<std::size_t>(view)]) {
      add(range.first, range.count);
    }
    first.assign(counts.size(), 0);
  } else {
    for (const std::uint32_t subject : seen) {
      const GpuMesh::Level level = LevelOf(index, form, draw_list_.levels(view, index)[subject]);
      add(static_cast<std::size_t>(level.first), static_cast<std::size_t>(level.count));
    }
  }
  const GLenum kind = form == PosedMeshes::Form::kPatches ? GL_PATCHES : GL_TRIANGLES;
  glMultiDrawElementsBaseVertex(kind, counts.data(), GL_UNSIGNED_INT, offsets.data(),
                                static_cast<GLsizei>(counts.size()), first.data());
}

// Patches have no levels: tessellation adapts them to the screen.
GpuMesh::Level SceneDraw::LevelOf(std::size_t index, PosedMeshes::Form form, int level) {
  if (form == PosedMeshes::Form::kPatches) return {0, gpu_->Patches(index).num_indices, 0.0f};
  const GpuMesh& mesh = gpu_->meshes()[index];
  if (mesh.levels.empty()) return {0, mesh.num_indices, 0.0f};
  return mesh.levels[static_cast<std::size_t>(level)];
}

Status SceneDraw::DrawShadow(const Settings& settings, int light) {
  buffers_.Bind();
  BindMasks();
  // A bound sampler overrides the texture's filtering until it is unbound, also in later passes.
  glBindSampler(kBaseColourUnit, cut_out_.name());
  Status status;
  for (std::size_t index = 0; index < gpu_->meshes().size() && status.ok(); ++index) {
    if (!draw_list_.seen(light, index).empty()) status = DrawCaster(settings, light, index);
  }
  glBindSampler(kBaseColourUnit, 0);
  return status;
}

Status SceneDraw::DrawCaster(const Settings& settings, int light, std::size_t index) {
  const int number = gpu_->meshes()[index].material;
  const GpuMaterial& material = gpu_->material(number);
  if (material.kind == character::Material::Kind::kShade) return {};
  SceneShader shader;
  if (tables_->IsDisplaced(material.group, settings)) {
    shader = SurfaceShader(material, {});
    shader.displaced = shader.shadow = true;
  }
  const Result<GLuint> program =
      shader.displaced ? shaders_->Get(shader) : shaders_->GetShadow(material.alpha_test);
  FURROW_RETURN_IF_ERROR(program);
  const auto form = shader.displaced ? PosedMeshes::Form::kPatches : PosedMeshes::Form::kIndexed;
  const WrinkleCache::Composed composed = ComposedOf(number, settings);  // same as in the scene
  BindMaterial(material, {{}, composed.rest});
  const Result<PosedMeshes::Vertices> posed = Pose(index, form, composed.rest);
  FURROW_RETURN_IF_ERROR(posed);
  SetCulling(!material.double_sided);
  glUseProgram(*program);
  glUniform1i(kLightLocation, light);
  DrawSubjects(*posed, index, form, light);
  return {};
}

void SceneDraw::AppendCasters(int light, std::vector<float>* values) const {
  for (std::size_t index = 0; index < gpu_->meshes().size(); ++index) {
    values->push_back(static_cast<float>(draw_list_.seen(light, index).size()));
    for (const int level : draw_list_.levels(light, index)) {
      values->push_back(static_cast<float>(level));
    }
    const DrawList::Parts* parts = draw_list_.parts(index);
    if (parts == nullptr) continue;
    for (const ElementRange& range : parts->indices[static_cast<std::size_t>(light)]) {
      values->insert(values->end(),
                     {static_cast<float>(range.first), static_cast<float>(range.count)});
    }
  }
}

Status SceneDraw::DrawScene(const Settings& settings, SceneKind kind) {
  buffers_.Bind();
  BindMasks();
  glBindTextureUnit(kWrinkleDerivativesUnit, gpu_->wrinkle_derivatives());
  glBindTextureUnit(kWrinkleLooksUnit, gpu_->wrinkle_looks());
  for (std::size_t mesh = 0; mesh < gpu_->meshes().size(); ++mesh) {
    if (draw_list_.seen(DrawList::kCamera, mesh).empty()) continue;
    FURROW_RETURN_IF_ERROR(DrawMesh(settings, kind, mesh));
  }
  return {};
}

Status SceneDraw::DrawMesh(const Settings& settings, SceneKind kind, std::size_t index) {
  const bool wireframe = kind == SceneKind::kPlain && settings.view == View::kWireframe;
  const int number = gpu_->meshes()[index].material;
  const GpuMaterial& material = gpu_->material(number);
  const bool shade = material.kind == character::Material::Kind::kShade;
  if (shade && !ShowsShade(settings)) return {};
  const WrinkleCache::Composed composed = ComposedOf(number, settings);
  SceneShader shader = ShaderFor(material, composed, settings, kind);
  shader.stretch = static_cast<bool>(gpu_->meshes()[index].gradients);
  const bool cuts_first = is_software_ && kind == SceneKind::kFacets && shader.alpha_test &&
                          !shader.displaced && !shade;
  if (cuts_first) shader.alpha_test = false;
  const Result<GLuint> program = shaders_->Get(shader);
  FURROW_RETURN_IF_ERROR(program);
  auto form = wireframe ? PosedMeshes::Form::kUnindexed : PosedMeshes::Form::kIndexed;
  if (shader.displaced) form = PosedMeshes::Form::kPatches;
  BindMaterial(material, composed);
  const Result<PosedMeshes::Vertices> posed = Pose(index, form, composed.rest);
  FURROW_RETURN_IF_ERROR(posed);
  if (shader.preintegrated) glBindTextureUnit(kPreintegratedUnit, lookup_tables_.preintegrated());
  SetCulling(!material.double_sided);
  if (cuts_first) FURROW_RETURN_IF_ERROR(DrawCutOutDepth(*posed, index, form));
  glUseProgram(*program);
  SetShade(shade);
  if (cuts_first) SetBehindCutOut(true);
  DrawSubjects(*posed, index, form, DrawList::kCamera);
  if (cuts_first) SetBehindCutOut(false);
  SetShade(false);
  return {};
}

// Draws the depth of a surface with a cut-out texture, so that the surface itself needs no discard.
// llvmpipe writes all targets of a block of pixels whose shader may discard, even if no pixel is
// left, and hair has many layers.
Status SceneDraw::DrawCutOutDepth(const PosedMeshes::Vertices& posed, std::size_t index,
                                  PosedMeshes::Form form) {
  SceneShader shader;
  shader.alpha_test = shader.shadow = true;
  const Result<GLuint> program = shaders_->Get(shader);
  FURROW_RETURN_IF_ERROR(program);
  glUseProgram(*program);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  DrawSubjects(posed, index, form, DrawList::kCamera);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  return {};
}

SceneShader SceneDraw::SurfaceShader(const GpuMaterial& material,
                                     const WrinkleCache::Composed& composed) const {
  SceneShader shader;
  if (material.group != WrinkleGroup::kNone) {
    const WrinkleNeeds needs = NeedsOf(tables_->table(material.group), composed.rest);
    shader.active_maps = PaddedMaps(needs.num_maps, tables_->num_maps());
    shader.wrinkle_texture = needs.uses_texture;
    shader.wrinkle_dynamic = needs.uses_dynamic;
  }
  shader.composed_looks = composed.textures.colour != 0;
  shader.base_colour_map = material.base_colour != 0 || shader.composed_looks;
  shader.base_normal_map = material.derivatives != 0 || composed.textures.derivatives != 0;
  shader.roughness_map = material.roughness != 0;
  shader.alpha_test = material.alpha_test;
  shader.emits = material.emits;
  shader.emission_map = material.emits && material.emission != 0;
  shader.mask_bits = tables_->mask_bits(material.group);
  shader.mask_layers = gpu_->layout().num_mask_layers;
  shader.map_slots = MapSlots(tables_->num_maps());
  shader.crowd = is_crowd_;
  return shader;
}

SceneShader SceneDraw::ShaderFor(const GpuMaterial& material,
                                 const WrinkleCache::Composed& composed, const Settings& settings,
                                 SceneKind kind) const {
  SceneShader shader = SurfaceShader(material, composed);
  shader.view = settings.view;
  shader.normal_blend = settings.normal_blend;
  shader.displaced =
      tables_->IsDisplaced(material.group, settings) && settings.view != View::kWireframe;
  shader.shade = material.kind == character::Material::Kind::kShade;
  shader.emission_target = kind == SceneKind::kFacets && gpu_->emits();
  if (kind == SceneKind::kPlain) return shader;
  const bool skin = material.kind == character::Material::Kind::kSkin;
  shader.shading = Shading::kSkin;
  shader.material = material.kind;
  shader.widen = settings.specular.widen;
  shader.wrinkle_looks = gpu_->wrinkle_looks() != 0;
  shader.thickness_map = skin && CanShineThrough(settings) && material.thickness != 0;
  shader.unlit = kind == SceneKind::kFacets;
  shader.motion = shader.unlit && has_motion_;
  if (shader.unlit || shader.shade) {
    shader.view = View::kFinal;
  } else {
    AddLight(settings, skin, &shader);
  }
  return shader;
}

// One program lights all facets, so it must support skin and select by the stored material.
SceneShader SceneDraw::LightShader(const Settings& settings) {
  SceneShader shader;
  shader.shading = Shading::kSkin;
  shader.any_material = true;
  AddLight(settings, true, &shader);
  return shader;
}

}  // namespace furrow::render
