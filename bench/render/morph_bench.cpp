// SPDX-License-Identifier: Apache-2.0
// The cost of blend shapes: a head of 20,301 vertices with 52 morph targets, each of which moves a
// third of the vertices, with none of them and with all of them in motion.
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include "render/mesh/mesh_morphs.h"
#include "render/renderer.h"
#include "tests/unit/render/character_parts.h"
#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

constexpr int kNumShapes = 52;  // ARKit's

character::Vertex OnTheHead(float u, float v) {
  const float longitude = glm::two_pi<float>() * u;
  const float latitude = glm::pi<float>() * v;
  character::Vertex vertex;
  vertex.normal = {-std::sin(longitude) * std::sin(latitude), std::cos(latitude),
                   -std::cos(longitude) * std::sin(latitude)};
  vertex.position = glm::vec3(0.0f, 1.6f, 0.0f) + 0.11f * vertex.normal;
  vertex.tangent = {-std::cos(longitude), 0.0f, std::sin(longitude), 1.0f};
  vertex.uv = {u, v};
  vertex.joints[0] = 1;
  return vertex;
}

// Moves the third of the sphere around `centre` by up to 1 cm and turns its normals. Every other
// shape moves inwards, so that the head keeps its size in the picture.
character::MorphTarget CapAround(const glm::vec3& centre, const character::Mesh& mesh, int shape) {
  const float height = shape % 2 == 0 ? 0.015f : -0.015f;
  character::MorphTarget target{.shape = shape, .deltas = {}};
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
    const glm::vec3& normal = mesh.vertices[i].normal;
    const float inside = glm::dot(normal, centre) - 1.0f / 3.0f;
    if (inside <= 0.0f) continue;
    target.deltas.push_back({i, height * inside * normal, 0.2f * inside * centre});
  }
  return target;
}

character::Character MakeFace() {
  character::Character face = test::MakeHead();
  character::Mesh& mesh = face.meshes[0];
  mesh.vertices.clear();
  mesh.indices.clear();
  test::AddGrid(200, 100, OnTheHead, &mesh);
  std::mt19937 random(1);
  std::normal_distribution<float> number;
  for (int shape = 0; shape < kNumShapes; ++shape) {
    const glm::vec3 centre =
        glm::normalize(glm::vec3(number(random), number(random), number(random)));
    face.shapes.push_back("shape" + std::to_string(shape));
    mesh.morph_targets.push_back(CapAround(centre, mesh, shape));
  }
  return face;
}

// Every weight changes from frame to frame, as in a live stream.
void MoveFace(int frame, std::vector<float>* shapes) {
  for (std::size_t i = 0; i < shapes->size(); ++i) {
    (*shapes)[i] =
        0.2f + 0.15f * std::sin(0.1f * static_cast<float>(frame) + static_cast<float>(i));
  }
}

// A diffuse frame with two frames in flight, as in the daemon. Both variants pose the mesh again in
// each frame. The difference between them is the cost of the morph targets.
void BM_Morph(benchmark::State& state) {
  static const character::Character face = MakeFace();
  static const auto renderer = test::Expect(Renderer::Create(face));
  test::Subject subject(face);
  FrameRequest request;
  request.model = subject.model;
  request.binding = &subject.binding;
  request.wrinkle_weights = subject.weights;
  request.filtered_values = subject.driver_values;
  request.camera = *renderer->Preset("face");
  request.width = request.height = 640;
  std::vector<float> shapes(static_cast<std::size_t>(state.range(0)) == 0 ? 0 : kNumShapes);
  int frame = 0;
  const auto submit = [&] {
    MoveFace(++frame, &shapes);
    request.shapes = shapes;
    subject.model[0][3].y += frame % 2 == 0 ? 1e-5f : -1e-5f;  // metres
    if (!renderer->Submit(request).ok()) std::abort();
  };
  submit();  // compiles the shaders
  for (auto _ : state) {
    if (renderer->in_flight() == 2) benchmark::DoNotOptimize(renderer->Poll(true));
    submit();
  }
  while (renderer->in_flight() > 0) (void)renderer->Poll(true).ok();
}
BENCHMARK(BM_Morph)
    ->ArgName("shapes")
    ->Arg(0)
    ->Arg(kNumShapes)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

// The part of it that sums the targets.
void BM_MorphSum(benchmark::State& state) {
  const MeshMorphs morphs(MakeFace().meshes[0]);
  std::vector<float> sums(morphs.num_floats());
  std::vector<float> shapes(kNumShapes);
  int frame = 0;
  for (auto _ : state) {
    MoveFace(++frame, &shapes);
    morphs.Sum(shapes, sums);
    benchmark::DoNotOptimize(sums.data());
  }
}
BENCHMARK(BM_MorphSum)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace furrow::render
