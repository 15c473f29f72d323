// SPDX-License-Identifier: Apache-2.0
#include "scene_probe.h"

#include <gtest/gtest.h>

#include "test_character.h"

namespace furrow::render::test {
namespace {

struct SinkData {
  FrameGraph::Handle colour;
};

}  // namespace

SceneProbe::SceneProbe(const character::Character& character)
    : character_(character),
      context_(Expect(EglContext::Create(""))),
      gpu_(Expect(GpuCharacter::Create(character))),
      tables_(Expect(WrinkleTables::Create(character, gpu_->layout()))),
      scene_(std::make_unique<SceneDraw>(character_.skeleton, character_.inverse_bind_matrices,
                                         gpu_.get(), tables_.get(), &shaders_,
                                         context_->is_software())),
      pass_(std::make_unique<ScenePass>(scene_.get(), &device_)) {}

std::vector<glm::vec4> SceneProbe::Draw(const FrameRequest& request) {
  FrameGraph graph;
  const ScenePass::Targets targets{request.width, request.height, PixelFormat::kRgba32F, 1};
  const Status updated = scene_->Update(request);
  EXPECT_TRUE(updated.ok()) << updated.ToString();
  const FrameGraph::Handle colour = pass_->AddPlain(&graph, request.settings, targets);
  std::vector<glm::vec4> pixels(static_cast<std::size_t>(request.width) * request.height);
  graph.AddPass<SinkData>(
      "probe",
      [&](FrameGraph::Builder& builder, SinkData& data) {
        data.colour = colour;
        builder.Read(colour);
        builder.SideEffect();
      },
      [&pixels](const FrameGraph::Resources& resources, const SinkData& data) {
        glGetTextureImage(resources.Get(data.colour), 0, GL_RGBA, GL_FLOAT,
                          static_cast<GLsizei>(pixels.size() * sizeof(glm::vec4)), pixels.data());
        return Status();
      });
  const Status compiled = graph.Compile();
  EXPECT_TRUE(compiled.ok()) << compiled.ToString();
  const Status drawn = graph.Execute(&pool_);
  EXPECT_TRUE(drawn.ok()) << drawn.ToString();
  pool_.EndFrame();
  return pixels;
}

}  // namespace furrow::render::test
