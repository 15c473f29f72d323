// SPDX-License-Identifier: Apache-2.0
#include "authoring/draco/draco_wire.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace furrow::authoring {
namespace {

std::vector<gltf::DracoMesh> Meshes() {
  return {{.num_points = 3,
           .indices = {0, 1, 2},
           .attributes = {{5, 5123, 1, {1, 0, 2, 0, 3, 0}}, {6, 5121, 2, {1, 2, 3, 4, 5, 6}}}},
          {}};
}

TEST(DracoWire, CallsComeBack) {
  const std::vector<std::uint8_t> a = {1, 2, 3};
  const std::vector<std::span<const std::uint8_t>> meshes = {a, {}};
  const std::string call = EncodeDracoCall(meshes);
  const auto back = DecodeDracoCall(call);
  ASSERT_TRUE(back.ok());
  ASSERT_EQ(back->size(), 2u);
  EXPECT_EQ((*back)[0], std::string_view("\1\2\3"));
  EXPECT_EQ((*back)[1], "");
}

TEST(DracoWire, MeshesComeBack) {
  const auto meshes = Meshes();
  const auto back = DecodeDracoMeshes(EncodeDracoMeshes(meshes));
  ASSERT_TRUE(back.ok());
  ASSERT_EQ(back->size(), 2u);
  const gltf::DracoMesh& mesh = (*back)[0];
  EXPECT_EQ(mesh.num_points, 3u);
  EXPECT_EQ(mesh.indices, meshes[0].indices);
  ASSERT_EQ(mesh.attributes.size(), 2u);
  EXPECT_EQ(mesh.attributes[1].id, 6u);
  EXPECT_EQ(mesh.attributes[1].component_type, 5121);
  EXPECT_EQ(mesh.attributes[1].components, 2);
  EXPECT_EQ(mesh.attributes[1].values, meshes[0].attributes[1].values);
}

// A helper that a hostile file has taken over may write anything.
TEST(DracoWire, EveryTruncationIsDamage) {
  const std::string bytes = EncodeDracoMeshes(Meshes());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_EQ(DecodeDracoMeshes(bytes.substr(0, size)).status().code(), StatusCode::kParse) << size;
  }
  EXPECT_FALSE(DecodeDracoMeshes(bytes + "x").ok());
  const std::vector<std::uint8_t> mesh = {1, 2, 3};
  const std::vector<std::span<const std::uint8_t>> meshes = {mesh};
  const std::string call = EncodeDracoCall(meshes);
  for (std::size_t size = 0; size < call.size(); ++size) {
    EXPECT_FALSE(DecodeDracoCall(call.substr(0, size)).ok()) << size;
  }
}

TEST(DracoWire, IndicesAndTypesAreChecked) {
  auto meshes = Meshes();
  meshes[0].indices[1] = 3;
  EXPECT_FALSE(DecodeDracoMeshes(EncodeDracoMeshes(meshes)).ok());
  meshes = Meshes();
  meshes[0].attributes[0].component_type = 5130;  // double
  EXPECT_FALSE(DecodeDracoMeshes(EncodeDracoMeshes(meshes)).ok());
  meshes = Meshes();
  meshes[0].attributes[0].components = 5;
  EXPECT_FALSE(DecodeDracoMeshes(EncodeDracoMeshes(meshes)).ok());
}

}  // namespace
}  // namespace furrow::authoring
