// SPDX-License-Identifier: Apache-2.0
// Meshes that gltf-pipeline compressed, in the real helper program.
#include "authoring/import/model/draco_call.h"

#include <cstring>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "gltf/container/glb.h"

namespace furrow::authoring {
namespace {

using Bytes = std::vector<std::uint8_t>;

// The compressed bytes of the head of toy_draco.glb: 81 vertices, 128 triangles.
Bytes CompressedHead() {
  const auto file =
      ReadFile(FURROW_SOURCE_DIR "/tests/unit/character/gltf/fixtures/toy_draco.glb", 1 << 20);
  EXPECT_TRUE(file.ok());
  const auto container = gltf::SplitContainer(*file);
  EXPECT_TRUE(container.ok());
  const auto json = nlohmann::json::parse(container->json);
  const auto& draco =
      json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"];
  const auto& view = json["bufferViews"][draco["bufferView"].get<std::size_t>()];
  const auto bytes = container->binary.substr(view.value("byteOffset", std::size_t{0}),
                                              view["byteLength"].get<std::size_t>());
  return {bytes.begin(), bytes.end()};
}

Result<std::vector<gltf::DracoMesh>> Decode(const Bytes& mesh) {
  const std::vector<std::span<const std::uint8_t>> meshes = {mesh};
  return DracoInHelper()(meshes);
}

TEST(DracoCall, DecodesWhatOthersCompressed) {
  const auto meshes = Decode(CompressedHead());
  ASSERT_TRUE(meshes.ok()) << meshes.status().ToString();
  ASSERT_EQ(meshes->size(), 1u);
  EXPECT_EQ((*meshes)[0].num_points, 81u);
  EXPECT_EQ((*meshes)[0].indices.size(), 3u * 128u);
  EXPECT_EQ((*meshes)[0].attributes.size(), 5u);
}

// Whatever the bytes are, there is a mesh or an error, and this process goes on.
TEST(DracoCall, DamageIsAnError) {
  const Bytes good = CompressedHead();
  EXPECT_FALSE(Decode({}).ok());
  EXPECT_FALSE(Decode(Bytes(good.begin(), good.begin() + 20)).ok());
  std::mt19937 random(3);
  int errors = 0;
  for (int i = 0; i < 40; ++i) {
    Bytes bad = good;
    for (int k = 0; k < 3; ++k) bad[random() % 80] = static_cast<std::uint8_t>(random());
    const auto meshes = Decode(bad);
    if (!meshes.ok()) ++errors;
  }
  EXPECT_GT(errors, 20);
}

// A header that states 1.4 thousand million triangles costs nothing here.
TEST(DracoCall, HugeCountsAreAnError) {
  Bytes bad = CompressedHead();
  ASSERT_EQ(std::memcmp(bad.data(), "DRACO", 5), 0);
  for (const std::uint8_t method : {0, 1}) {  // sequential, edgebreaker
    bad[8] = method;
    for (std::size_t i = 11; i < 26; ++i) bad[i] = i % 5 == 0 ? 0x05 : 0xff;
    EXPECT_FALSE(Decode(bad).ok());
  }
}

}  // namespace
}  // namespace furrow::authoring
