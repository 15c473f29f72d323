// SPDX-License-Identifier: Apache-2.0
// Files that other programs wrote; see the scripts of fixtures/ (make_*).
#include <filesystem>
#include <limits>
#include <string>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "authoring/import/model/draco_call.h"
#include "base/files.h"
#include "character/package/package.h"

namespace furrow::character {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr float kNear = 2e-4f;  // metres; gltfpack stores 14 to 16 bits of 0.2 m

Character Fixture(const std::string& name) {
  const std::filesystem::path folder = FURROW_SOURCE_DIR "/tests/unit/character/gltf/fixtures";
  const auto bytes = ReadFile(folder / name, 1 << 20);
  EXPECT_TRUE(bytes.ok()) << bytes.status().ToString();
  if (!bytes.ok()) return {};
  const gltf::DracoDecoder draco = authoring::DracoInHelper();
  auto character = ParseCharacter(*bytes, folder, {.draco = &draco});
  EXPECT_TRUE(character.ok()) << character.status().ToString();
  return character.ok() ? std::move(*character) : Character();
}

// The vertex of a mesh that is nearest to a place.
std::uint32_t Nearest(const Mesh& mesh, const glm::vec3& place) {
  std::uint32_t best = 0;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    if (glm::distance(mesh.vertices[v].position, place) <
        glm::distance(mesh.vertices[best].position, place)) {
      best = v;
    }
  }
  return best;
}

// What a shape does to a vertex.
MorphDelta DeltaOf(const Character& character, std::size_t mesh, int shape, std::uint32_t vertex) {
  for (const MorphTarget& target : character.meshes[mesh].morph_targets) {
    if (target.shape != shape) continue;
    for (const MorphDelta& delta : target.deltas) {
      if (delta.vertex == vertex) return delta;
    }
  }
  return {};
}

float WeightOf(const Vertex& vertex, int joint) {
  float weight = 0.0f;
  for (int i = 0; i < 4; ++i) weight += vertex.joints[i] == joint ? vertex.skin_weights[i] : 0.0f;
  return weight;
}

class ForeignGltf : public ::testing::TestWithParam<const char*> {};

TEST_P(ForeignGltf, EqualsItsOriginal) {
  const Character toy = Fixture("toy.glb");
  const Character copy = Fixture(GetParam());
  EXPECT_THAT(copy.warnings, IsEmpty());
  EXPECT_THAT(copy.shapes, ElementsAre("jawOpen", "smile"));
  EXPECT_EQ(copy.skeleton.rest_model()[1], toy.skeleton.rest_model()[1]);
  ASSERT_EQ(copy.meshes.size(), toy.meshes.size());
  for (std::size_t m = 0; m < toy.meshes.size(); ++m) {
    ASSERT_EQ(copy.meshes[m].indices.size(), toy.meshes[m].indices.size());
    for (std::uint32_t v = 0; v < toy.meshes[m].vertices.size(); ++v) {
      const Vertex& a = toy.meshes[m].vertices[v];
      const std::uint32_t w = Nearest(copy.meshes[m], a.position);
      const Vertex& b = copy.meshes[m].vertices[w];
      ASSERT_LT(glm::distance(a.position, b.position), kNear) << m << " " << v;
      EXPECT_LT(glm::distance(a.normal, b.normal), 0.02f);
      EXPECT_LT(glm::distance(a.uv, b.uv), 1e-3f);
      for (int joint = 0; joint < 3; ++joint) {
        const int same = copy.skeleton.Find(toy.skeleton.joint_names()[joint]);
        EXPECT_NEAR(WeightOf(a, joint), WeightOf(b, same), 0.01f);
      }
      for (int shape = 0; shape < 2; ++shape) {
        const MorphDelta from = DeltaOf(toy, m, shape, v);
        const MorphDelta to = DeltaOf(copy, m, shape, w);
        EXPECT_LT(glm::distance(from.position, to.position), kNear) << shape << " " << v;
        EXPECT_LT(glm::distance(from.normal, to.normal), 0.03f) << shape << " " << v;
      }
    }
  }
}

// Both meshes are skinned in the rest pose, however the file binds them.
TEST_P(ForeignGltf, IsBoundInTheRestPose) {
  const Character copy = Fixture(GetParam());
  for (std::size_t j = 0; j < copy.inverse_bind_matrices.size(); ++j) {
    const glm::mat4 skin = copy.skeleton.rest_model()[j] * copy.inverse_bind_matrices[j];
    for (int k = 0; k < 4; ++k) {
      EXPECT_LT(glm::distance(skin[k], glm::mat4(1.0f)[k]), 1e-5f) << j << " " << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Compressed, ForeignGltf,
                         ::testing::Values("toy_meshopt.glb", "toy_meshopt_filtered.glb",
                                           "toy_meshopt_fallback.gltf"),
                         [](const auto& info) {
                           return std::filesystem::path(info.param).stem().string();
                         });

TEST(ForeignGltf, NewerMeshoptIsNamed) {
  const std::filesystem::path folder = FURROW_SOURCE_DIR "/tests/unit/character/gltf/fixtures";
  const auto character = LoadCharacter(folder / "toy_meshopt_khr.glb");
  EXPECT_EQ(character.status().code(), StatusCode::kUnsupported) << character.status().ToString();
}

std::string TestNameOf(const ::testing::TestParamInfo<const char*>& info) {
  return std::filesystem::path(info.param).stem().string();
}

INSTANTIATE_TEST_SUITE_P(Quantised, ForeignGltf,
                         ::testing::Values("toy_float.glb", "toy_quantised.glb",
                                           "toy_normalised.glb"),
                         TestNameOf);

INSTANTIATE_TEST_SUITE_P(Draco, ForeignGltf,
                         ::testing::Values("toy_draco.glb", "toy_draco_sequential.glb"),
                         TestNameOf);

INSTANTIATE_TEST_SUITE_P(Webp, ForeignGltf, ::testing::Values("toy_webp.glb"), TestNameOf);

// gltf-transform compressed the PNG without loss.
TEST(ForeignGltf, WebpHasThePixelsOfThePng) {
  const Character toy = Fixture("toy.glb");
  const Character webp = Fixture("toy_webp.glb");
  ASSERT_EQ(webp.pictures.size(), 1u);
  ASSERT_GE(webp.materials[0].base_colour_texture, 0);
  EXPECT_EQ(webp.pictures[0].width, 16);
  EXPECT_EQ(webp.pictures[0].channels, toy.pictures[0].channels);
  EXPECT_EQ(webp.pictures[0].pixels, toy.pictures[0].pixels);
}

// Packages have no Draco, so the readers of packages have no decoder.
TEST(ForeignGltf, DracoNeedsAnImport) {
  const std::filesystem::path folder = FURROW_SOURCE_DIR "/tests/unit/character/gltf/fixtures";
  const Status status = LoadCharacter(folder / "toy_draco.glb").status();
  EXPECT_EQ(status.code(), StatusCode::kUnsupported);
  EXPECT_THAT(status.todo(), ::testing::HasSubstr("furrow character import"));
}

}  // namespace
}  // namespace furrow::character
