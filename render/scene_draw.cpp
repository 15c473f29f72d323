// SPDX-License-Identifier: Apache-2.0
#include "render/scene_draw.h"

#include <algorithm>
#include <bit>

#include "render/displacement_patches.h"

namespace furrow::render {
namespace {

// Binding points of shaders/common_*.glsl and scene.frag.glsl.
enum UniformBinding : GLuint { kFrameBlock = 0, kMaterialBlock = 1, kWrinkleTable = 2 };
enum StorageBinding : GLuint {
  kJointRows = 0,
  kJointInfluences = 1,
  kMaskPalette = 2,
  kDynamicMasks = 3
};
enum TextureUnit : GLuint {
  kBaseColourUnit = 0,
  kBaseDerivativesUnit = 1,
  kMasksUnit = 2,
  kWrinkleDerivativesUnit = 3,
  kRoughnessUnit = 4,
  kShadowCompareUnit = 5,
  kShadowDepthUnit = 6,
  kBeckmannUnit = 7,
  kSpecularAlbedoUnit = 8,
  kPreintegratedUnit = 9,
  kWrinkleLooksUnit = 10,
  kThicknessUnit = 11,
  kWrinkleHeightsUnit = 12
};
constexpr GLint kLightLocation = 0;        // of shadow.vert.glsl and displace.tese.glsl
constexpr GLint kHeightTexelLocation = 1;  // of displace.tese.glsl

void SetCulling(bool cull) {
  if (cull) {
    glEnable(GL_CULL_FACE);
  } else {
    glDisable(GL_CULL_FACE);
  }
}

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

// For the holes of a base colour in a shadow: one texel says enough of them.
gl::Sampler MakeCutOutSampler() {
  gl::Sampler sampler = gl::MakeSampler();
  glSamplerParameteri(sampler.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
  glSamplerParameteri(sampler.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return sampler;
}

// Programs are compiled for a power of two of maps, so that a face that begins to move does not
// wait for one after the other; the rest of the list is zeros, which add nothing.
int PaddedMaps(std::size_t num_maps, int map_slots) {
  if (num_maps == 0) return 0;
  return std::min(static_cast<int>(std::bit_ceil(num_maps)), 4 * map_slots);
}

// The views that the skin pipeline's scene pass itself draws differently for.
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

}  // namespace

SceneDraw::SceneDraw(const wrinkle::Skeleton& skeleton,
                     std::span<const glm::mat4> inverse_bind_matrices, GpuCharacter* gpu,
                     WrinkleTables* tables, ShaderLibrary* shaders)
    : skeleton_(skeleton),
      inverse_bind_matrices_(inverse_bind_matrices),
      gpu_(gpu),
      tables_(tables),
      shaders_(shaders),
      shadow_compare_(MakeShadowSampler(true)),
      shadow_depth_(MakeShadowSampler(false)),
      cut_out_(MakeCutOutSampler()) {
  for (gl::Buffer* buffer : {&frame_, &joints_, &influences_}) *buffer = gl::MakeBuffer();
  for (int group = 0; group < kNumWrinkleGroups; ++group) {
    wrinkle_tables_[group] = gl::MakeBuffer();
    dynamic_masks_[group] = gl::MakeBuffer();
  }
  for (int group = 0; group <= kNumWrinkleGroups; ++group) {
    const auto palette = tables_->mask_palette(static_cast<WrinkleGroup>(group));
    palettes_[group] = gl::MakeStaticBuffer(palette.data(), palette.size_bytes());
  }
}

Status SceneDraw::Update(const FrameRequest& request) {
  if (Status status = tables_->Update(request); !status.ok()) return status;
  setup_ = SetUpFrame(request, skeleton_, &ambient_);
  const Settings& settings = request.settings;
  displacement_reach_ = settings.displacement.enabled
                            ? 0.001f * settings.displacement.strength * settings.wrinkle_strength *
                                  gpu_->heights().most_mm
                            : 0.0f;
  FindVisible(request.model);
  UploadFrame(request.settings);
  UploadJoints(request.model);
  UploadWrinkles();
  return {};
}

void SceneDraw::FindVisible(std::span<const glm::mat4> model) {
  constexpr int kAny = 4096;  // pixels: of a picture of any size, only its border matters
  const auto look = [&](const glm::mat4& projection, std::vector<bool>* visible) {
    visible->clear();
    for (const GpuMesh& mesh : gpu_->meshes()) {
      visible->push_back(
          !mesh.bounds.Project(model, projection, kAny, kAny, displacement_reach_).empty());
    }
  };
  look(setup_.camera.view_projection, &seen_);
  for (int light = 0; light < kNumLights; ++light) {
    const bool dark = setup_.lighting.lights[light].radiance == glm::vec3(0.0f);
    if (dark) {
      casts_[light].assign(gpu_->meshes().size(), false);  // nobody asks for its shadow
    } else {
      look(FlatProjection(setup_.shadows[light]), &casts_[light]);
    }
  }
}

void SceneDraw::UploadFrame(const Settings& settings) {
  const FrameBlock block = MakeFrameBlock(setup_, settings);
  gl::Upload(frame_, &block, sizeof(block));
}

void SceneDraw::UploadJoints(std::span<const glm::mat4> model) {
  std::vector<glm::vec4> rows;
  const std::size_t num_joints = inverse_bind_matrices_.size();
  rows.reserve(num_joints * 3);
  for (std::size_t joint = 0; joint < num_joints; ++joint) {
    const glm::mat4 rowwise = glm::transpose(model[joint] * inverse_bind_matrices_[joint]);
    for (int row = 0; row < 3; ++row) rows.push_back(rowwise[row]);
  }
  gl::Upload(joints_, rows.data(), rows.size() * sizeof(glm::vec4));
}

void SceneDraw::UploadWrinkles() {
  const DynamicMasks& dynamic = tables_->dynamic_masks();
  for (int group = 0; group < kNumWrinkleGroups; ++group) {
    const WrinkleTable& table = tables_->table(static_cast<WrinkleGroup>(group));
    const auto block = WrinkleBlock(table, tables_->num_maps(), gpu_->layout());
    gl::Upload(wrinkle_tables_[group], block.data(), block.size());
    const auto masks = DynamicMasksBlock(table.dynamic_masks, dynamic.num_columns());
    gl::Upload(dynamic_masks_[group], masks.data(), masks.size());
  }
  gl::Upload(influences_, dynamic.influences().data(), dynamic.influences().size_bytes());
}

void SceneDraw::BindBuffers() {
  glBindBufferBase(GL_UNIFORM_BUFFER, kFrameBlock, frame_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kJointRows, joints_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kJointInfluences, influences_.name());
}

void SceneDraw::BindMasks() {
  glBindTextureUnit(kMasksUnit, gpu_->masks());
  glBindTextureUnit(kWrinkleHeightsUnit, gpu_->heights().texture.name());
}

void SceneDraw::BindMaterial(const GpuMaterial& material) {
  glBindBufferBase(GL_UNIFORM_BUFFER, kMaterialBlock, material.block.name());
  const int group = material.group == WrinkleGroup::kNone ? 0 : static_cast<int>(material.group);
  glBindBufferBase(GL_UNIFORM_BUFFER, kWrinkleTable, wrinkle_tables_[group].name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kDynamicMasks, dynamic_masks_[group].name());
  const GLuint palette = palettes_[static_cast<int>(material.group)].name();
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kMaskPalette, palette);
  glBindTextureUnit(kBaseColourUnit, material.base_colour);
  glBindTextureUnit(kBaseDerivativesUnit, material.derivatives);
  glBindTextureUnit(kRoughnessUnit, material.roughness);
  glBindTextureUnit(kThicknessUnit, material.thickness);
}

void SceneDraw::BindTables(GLuint shadows) {
  glBindTextureUnit(kShadowCompareUnit, shadows);
  glBindSampler(kShadowCompareUnit, shadow_compare_.name());
  glBindTextureUnit(kShadowDepthUnit, shadows);
  glBindSampler(kShadowDepthUnit, shadow_depth_.name());
  glBindTextureUnit(kBeckmannUnit, lookup_tables_.beckmann());
  glBindTextureUnit(kSpecularAlbedoUnit, lookup_tables_.specular_albedo());
}

bool SceneDraw::IsDisplaced(const GpuMaterial& material, const Settings& settings) const {
  return settings.displacement.enabled && settings.displacement.strength > 0.0f &&
         material.group != WrinkleGroup::kNone && tables_->table(material.group).has_heights;
}

void SceneDraw::DrawTriangles(const SceneShader& shader, std::size_t index) {
  if (!shader.displaced) {
    const GpuMesh& mesh = gpu_->meshes()[index];
    glBindVertexArray(mesh.vertex_array.name());
    glDrawElements(GL_TRIANGLES, mesh.num_indices, GL_UNSIGNED_INT, nullptr);
    return;
  }
  const GpuPatches& patches = gpu_->Patches(index);
  glUniform1f(kHeightTexelLocation,
              patches.metres_per_uv / static_cast<float>(gpu_->heights().side));
  glPatchParameteri(GL_PATCH_VERTICES, DisplacementPatches::kCorners);
  glBindVertexArray(patches.vertex_array.name());
  glDrawElements(GL_PATCHES, patches.num_indices, GL_UNSIGNED_INT, nullptr);
}

Status SceneDraw::DrawShadow(const Settings& settings, int light) {
  BindBuffers();
  BindMasks();
  glBindSampler(kBaseColourUnit, cut_out_.name());
  for (std::size_t index = 0; index < gpu_->meshes().size(); ++index) {
    if (!casts_[light][index]) continue;
    const GpuMesh& mesh = gpu_->meshes()[index];
    const GpuMaterial& material = gpu_->material(mesh.material);
    SceneShader shader;
    if (IsDisplaced(material, settings)) {
      shader = SurfaceShader(material);
      shader.displaced = shader.shadow = true;
    }
    const Result<GLuint> program =
        shader.displaced ? shaders_->Get(shader) : shaders_->GetShadow(material.alpha_test);
    if (!program.ok()) return program.status();
    glUseProgram(*program);
    glUniform1i(kLightLocation, light);
    BindMaterial(material);
    SetCulling(false);
    DrawTriangles(shader, index);
  }
  glBindSampler(kBaseColourUnit, 0);
  return {};
}

Status SceneDraw::DrawScene(const Settings& settings, Shading shading) {
  BindBuffers();
  BindMasks();
  glBindTextureUnit(kWrinkleDerivativesUnit, gpu_->wrinkle_derivatives());
  glBindTextureUnit(kWrinkleLooksUnit, gpu_->wrinkle_looks());
  for (std::size_t mesh = 0; mesh < gpu_->meshes().size(); ++mesh) {
    if (!seen_[mesh]) continue;
    if (Status status = DrawMesh(settings, shading, mesh); !status.ok()) return status;
  }
  return {};
}

Status SceneDraw::DrawMesh(const Settings& settings, Shading shading, std::size_t index) {
  const bool wireframe = shading == Shading::kDiffuse && settings.view == View::kWireframe;
  const GpuMesh& mesh = gpu_->meshes()[index];
  const GpuMaterial& material = gpu_->material(mesh.material);
  const SceneShader shader = ShaderFor(material, settings, shading);
  const Result<GLuint> program = shaders_->Get(shader);
  if (!program.ok()) return program.status();
  if (shader.preintegrated) glBindTextureUnit(kPreintegratedUnit, lookup_tables_.preintegrated());
  glUseProgram(*program);
  BindMaterial(material);
  SetCulling(!material.double_sided);
  if (wireframe) {
    glBindVertexArray(gpu_->Unindexed(index).vertex_array.name());
    glDrawArrays(GL_TRIANGLES, 0, mesh.num_indices);
  } else {
    DrawTriangles(shader, index);
  }
  return {};
}

SceneShader SceneDraw::SurfaceShader(const GpuMaterial& material) const {
  SceneShader shader;
  if (material.group != WrinkleGroup::kNone) {
    shader.active_maps =
        PaddedMaps(tables_->table(material.group).maps.size(), MapSlots(tables_->num_maps()));
    shader.wrinkle_texture = tables_->table(material.group).uses_texture;
    shader.wrinkle_dynamic = tables_->table(material.group).uses_dynamic;
  }
  shader.base_colour_map = material.base_colour != 0;
  shader.base_normal_map = material.derivatives != 0;
  shader.roughness_map = material.roughness != 0;
  shader.alpha_test = material.alpha_test;
  shader.mask_bits = tables_->mask_bits(material.group);
  shader.mask_layers = gpu_->layout().num_mask_layers;
  shader.map_slots = MapSlots(tables_->num_maps());
  return shader;
}

SceneShader SceneDraw::ShaderFor(const GpuMaterial& material, const Settings& settings,
                                 Shading shading) const {
  SceneShader shader = SurfaceShader(material);
  shader.view = settings.view;
  shader.normal_blend = settings.normal_blend;
  shader.displaced = IsDisplaced(material, settings) && settings.view != View::kWireframe;
  if (shading == Shading::kDiffuse) return shader;
  const bool skin = material.kind == character::Material::Kind::kSkin;
  shader.view = SkinView(settings.view);
  shader.shading = shading;
  shader.material = material.kind;
  shader.shadow_filter = settings.shadow.filter;
  shader.shadow_lamps = settings.shadow.filter == ShadowFilter::kOff ? 0 : settings.shadow.lamps;
  shader.shadow_taps = settings.shadow.taps;
  shader.translucency =
      skin && settings.translucency.enabled && settings.shadow.filter != ShadowFilter::kOff;
  shader.preintegrated = skin && settings.subsurface.method == SubsurfaceMethod::kPreintegrated;
  shader.widen = settings.specular.widen;
  shader.wrinkle_looks = gpu_->wrinkle_looks() != 0;
  shader.thickness_map = shader.translucency && material.thickness != 0;
  shader.beckmann_table = settings.specular.table;
  shader.gems = settings.specular.mode == SpecularMode::kGems;
  shader.conserve_energy = settings.specular.conserve_energy;
  return shader;
}

}  // namespace furrow::render
