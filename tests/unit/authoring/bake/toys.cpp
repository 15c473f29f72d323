// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/authoring/bake/toys.h"

#include <utility>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "character/mesh/tangents.h"

namespace furrow::authoring::toys {

character::Mesh Grid(int columns, int rows, const std::function<Point(float, float)>& point) {
  character::Mesh mesh;
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column <= columns; ++column) {
      const Point p = point(static_cast<float>(column) / static_cast<float>(columns),
                            static_cast<float>(row) / static_cast<float>(rows));
      character::Vertex vertex;
      vertex.position = p.position;
      vertex.uv = p.uv;
      vertex.joints[1] = 1;
      vertex.skin_weights[0] = 1.0f - p.weight_of_second;
      vertex.skin_weights[1] = p.weight_of_second;
      mesh.vertices.push_back(vertex);
    }
  }
  const auto index = [&](int column, int row) {
    return static_cast<std::uint32_t>(row * (columns + 1) + column);
  };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const std::uint32_t a = index(column, row), b = index(column + 1, row);
      const std::uint32_t c = index(column + 1, row + 1), d = index(column, row + 1);
      for (const std::uint32_t corner : {a, b, c, a, c, d}) mesh.indices.push_back(corner);
    }
  }
  character::paint::ComputeNormals(mesh.vertices, mesh.indices);
  character::paint::ComputeTangents(mesh.vertices, mesh.indices);
  return mesh;
}

void Append(const character::Mesh& from, character::Mesh* to) {
  const auto base = static_cast<std::uint32_t>(to->vertices.size());
  to->vertices.insert(to->vertices.end(), from.vertices.begin(), from.vertices.end());
  for (const std::uint32_t index : from.indices) to->indices.push_back(base + index);
}

character::Character Wearing(character::Mesh mesh, bool cloth) {
  character::Character character;
  character.name = "toy";
  std::vector<wrinkle::JointDesc> joints(2);
  joints[0].name = "a";
  joints[1].name = "b";
  joints[1].parent = 0;
  Result<wrinkle::Skeleton> skeleton = wrinkle::Skeleton::Create(joints);
  EXPECT_TRUE(skeleton.ok());
  character.skeleton = std::move(skeleton).value();
  character.inverse_bind_matrices.assign(2, glm::mat4(1.0f));
  character::Material skin;
  skin.kind = cloth ? character::Material::Kind::kCloth : character::Material::Kind::kSkin;
  character.materials.push_back(skin);
  mesh.material = 0;
  character.meshes.push_back(std::move(mesh));
  wrinkle::WrinkleMap map;
  map.name = "folds";
  map.surface = cloth ? wrinkle::WrinkleMap::Surface::kCloth : wrinkle::WrinkleMap::Surface::kSkin;
  character.rig.wrinkle_maps.push_back(map);
  wrinkle::Region region;
  region.name = "patch";
  region.mask.kind = wrinkle::Mask::Kind::kSkinning;
  region.feeds.push_back({"folds", {}});
  character.rig.regions.push_back(region);
  return character;
}

character::Mesh Sheet(float width, float height, int columns, int rows) {
  return Grid(columns, rows, [&](float u, float v) {
    return Point{{u * width, v * height, 0.0f}, {u, 1.0f - v}, 0.0f};
  });
}

BakePose Pose(const glm::mat4& first, const glm::mat4& second) {
  return {.map = "folds", .region = {}, .skin_matrices = {first, second}, .weight = 1.0f};
}

glm::mat4 Squeeze(float compression, float degrees) {
  const glm::mat4 turn =
      glm::rotate(glm::mat4(1.0f), glm::radians(degrees), glm::vec3(0.0f, 0.0f, 1.0f));
  const glm::mat4 scale = glm::scale(glm::mat4(1.0f), glm::vec3(1.0f - compression, 1.0f, 1.0f));
  return turn * scale * glm::inverse(turn);
}

BakeOptions Exact() {
  BakeOptions options;
  options.size = 256;
  options.threads = 1;
  options.skin.wavelength_mm = 10.0f;
  options.skin.variation = 0.0f;
  options.skin.share = 1.0f;
  options.skin.threshold = 0.0f;
  options.skin.grain = 0.0f;
  options.skin.max_compression = 0.7f;
  return options;
}

BakedMap BakeFolds(const character::Character& character, std::vector<BakePose> poses,
                   const BakeOptions& options, std::vector<BakeStroke> strokes) {
  Result<BakedMaps> maps = Bake(character, poses, strokes, options);
  EXPECT_TRUE(maps.ok()) << maps.status().ToString();
  if (!maps.ok() || maps.value().maps.size() != 1) {
    ADD_FAILURE() << "expected one map";
    return {};
  }
  return std::move(maps.value().maps.front());
}

}  // namespace furrow::authoring::toys
