// SPDX-License-Identifier: Apache-2.0
#include "render/passes/scene_pass.h"

#include <array>

#include "render/lighting.h"

namespace furrow::render {
namespace {

// Binding points of shaders/common_*.glsl and scene.frag.glsl.
enum UniformBinding : GLuint { kFrameBlock = 0, kMaterialBlock = 1, kWrinkleTable = 2 };
enum StorageBinding : GLuint { kJointRows = 0, kJointInfluences = 1, kMaskPalette = 2 };
enum TextureUnit : GLuint {
  kBaseColourUnit = 0,
  kBaseDerivativesUnit = 1,
  kMasksUnit = 2,
  kWrinkleDerivativesUnit = 3,
  kRoughnessUnit = 4
};

// Mirrors the Frame block of common_frame.glsl (std140).
struct FrameBlock {
  glm::mat4 view_projection;
  glm::vec4 camera_position;
  std::array<Light, kNumLights> lights;
  glm::vec4 ambient_sky;
  glm::vec4 ambient_ground;
};

// The views that show data, not light: no background but black.
bool IsData(View view) {
  return view == View::kNormal || view == View::kMaskDynamic || view == View::kMaskTexture;
}

}  // namespace

ScenePass::ScenePass(const wrinkle::Skeleton& skeleton,
                     std::span<const glm::mat4> inverse_bind_matrices, GpuCharacter* gpu,
                     WrinkleTables* tables, ShaderLibrary* shaders, GlDevice* device)
    : skeleton_(skeleton),
      inverse_bind_matrices_(inverse_bind_matrices),
      gpu_(gpu),
      tables_(tables),
      shaders_(shaders),
      device_(device) {
  for (gl::Buffer* buffer : {&frame_, &joints_, &influences_}) *buffer = gl::MakeBuffer();
  for (int group = 0; group < kNumWrinkleGroups; ++group) {
    wrinkle_tables_[group] = gl::MakeBuffer();
  }
  for (int group = 0; group <= kNumWrinkleGroups; ++group) {
    const auto palette = tables_->mask_palette(static_cast<WrinkleGroup>(group));
    palettes_[group] = gl::MakeStaticBuffer(palette.data(), palette.size_bytes());
  }
}

Result<FrameGraph::Handle> ScenePass::Add(FrameGraph* graph, const FrameRequest& request,
                                          const Targets& targets) {
  if (Status status = tables_->Update(request); !status.ok()) return status;
  UploadFrame(request);
  UploadJoints(request.model);
  UploadWrinkles();
  struct Data {
    FrameGraph::Handle colour;
    FrameGraph::Handle depth;
  };
  const Data data = graph->AddPass<Data>(
      "scene",
      [&](FrameGraph::Builder& builder, Data& pass) {
        TextureDesc desc{targets.width, targets.height, targets.format, targets.samples};
        pass.colour = builder.Write(builder.Create("scene colour", desc));
        desc.format = PixelFormat::kDepth32F;
        pass.depth = builder.Write(builder.Create("scene depth", desc));
      },
      [this, settings = request.settings](const FrameGraph::Resources& resources,
                                          const Data& pass) {
        const GLuint framebuffer =
            device_->Framebuffer(resources.Get(pass.colour), resources.Get(pass.depth));
        return Draw(settings, framebuffer, resources.Desc(pass.colour));
      });
  return data.colour;
}

void ScenePass::UploadFrame(const FrameRequest& request) {
  const float aspect = static_cast<float>(request.width) / static_cast<float>(request.height);
  const CameraFrame camera = ComputeCamera(request.camera, skeleton_, request.model, aspect);
  const Lighting lighting = StudioLighting(camera.heading);
  const FrameBlock block{camera.view_projection, glm::vec4(camera.position, 1.0f), lighting.lights,
                         lighting.ambient_sky, lighting.ambient_ground};
  gl::Upload(frame_, &block, sizeof(block));
}

void ScenePass::UploadJoints(std::span<const glm::mat4> model) {
  std::vector<glm::vec4> rows;
  const std::size_t num_joints = inverse_bind_matrices_.size();
  rows.reserve(num_joints * 3);
  for (std::size_t joint = 0; joint < num_joints; ++joint) {
    const glm::mat4 rowwise = glm::transpose(model[joint] * inverse_bind_matrices_[joint]);
    for (int row = 0; row < 3; ++row) rows.push_back(rowwise[row]);
  }
  gl::Upload(joints_, rows.data(), rows.size() * sizeof(glm::vec4));
}

void ScenePass::UploadWrinkles() {
  for (int group = 0; group < kNumWrinkleGroups; ++group) {
    const std::vector<std::uint8_t> block = WrinkleBlock(
        tables_->table(static_cast<WrinkleGroup>(group)), tables_->num_maps(), gpu_->layout());
    gl::Upload(wrinkle_tables_[group], block.data(), block.size());
  }
  gl::Upload(influences_, tables_->joint_influences().data(),
             tables_->joint_influences().size_bytes());
}

Status ScenePass::Draw(const Settings& settings, GLuint framebuffer, const TextureDesc& target) {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, target.width, target.height);
  const glm::vec3 background = IsData(settings.view) ? glm::vec3(0.0f) : settings.background;
  const float clear_colour[4] = {background.r, background.g, background.b, 1.0f};
  const float clear_depth = 1.0f;
  glDepthMask(GL_TRUE);
  glClearNamedFramebufferfv(framebuffer, GL_COLOR, 0, clear_colour);
  glClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, &clear_depth);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glCullFace(GL_BACK);
  glBindBufferBase(GL_UNIFORM_BUFFER, kFrameBlock, frame_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kJointRows, joints_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kJointInfluences, influences_.name());
  glBindTextureUnit(kMasksUnit, gpu_->masks());
  glBindTextureUnit(kWrinkleDerivativesUnit, gpu_->wrinkle_derivatives());
  for (std::size_t mesh = 0; mesh < gpu_->meshes().size(); ++mesh) {
    if (Status status = DrawMesh(settings, mesh); !status.ok()) return status;
  }
  return {};
}

Status ScenePass::DrawMesh(const Settings& settings, std::size_t index) {
  const bool wireframe = settings.view == View::kWireframe;
  const GpuMesh& mesh = wireframe ? gpu_->Unindexed(index) : gpu_->meshes()[index];
  const GpuMaterial& material = gpu_->material(mesh.material);
  const Result<GLuint> program = shaders_->Get(ShaderFor(material, settings));
  if (!program.ok()) return program.status();
  glUseProgram(*program);
  glBindBufferBase(GL_UNIFORM_BUFFER, kMaterialBlock, material.block.name());
  const int group = material.group == WrinkleGroup::kNone ? 0 : static_cast<int>(material.group);
  glBindBufferBase(GL_UNIFORM_BUFFER, kWrinkleTable, wrinkle_tables_[group].name());
  const GLuint palette = palettes_[static_cast<int>(material.group)].name();
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kMaskPalette, palette);
  glBindTextureUnit(kBaseColourUnit, material.base_colour);
  glBindTextureUnit(kBaseDerivativesUnit, material.derivatives);
  glBindTextureUnit(kRoughnessUnit, material.roughness);
  if (material.double_sided) {
    glDisable(GL_CULL_FACE);
  } else {
    glEnable(GL_CULL_FACE);
  }
  glBindVertexArray(mesh.vertex_array.name());
  if (wireframe) {
    glDrawArrays(GL_TRIANGLES, 0, mesh.num_indices);
  } else {
    glDrawElements(GL_TRIANGLES, mesh.num_indices, GL_UNSIGNED_INT, nullptr);
  }
  return {};
}

SceneShader ScenePass::ShaderFor(const GpuMaterial& material, const Settings& settings) const {
  SceneShader shader;
  shader.view = settings.view;
  shader.normal_blend = settings.normal_blend;
  if (material.group != WrinkleGroup::kNone) {
    shader.active_maps = static_cast<int>(tables_->table(material.group).maps.size());
    shader.wrinkle_texture = tables_->table(material.group).uses_texture;
    shader.wrinkle_dynamic = tables_->table(material.group).uses_dynamic;
  }
  shader.base_colour_map = material.base_colour != 0;
  shader.base_normal_map = material.derivatives != 0;
  shader.roughness_map = material.roughness != 0;
  shader.alpha_test = material.alpha_test;
  shader.mask_layers = gpu_->layout().num_mask_layers;
  shader.map_slots = MapSlots(tables_->num_maps());
  return shader;
}

}  // namespace furrow::render
