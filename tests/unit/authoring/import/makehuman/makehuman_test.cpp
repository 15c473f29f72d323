// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/makehuman.h"

#include <cmath>
#include <set>
#include <string>
#include <tuple>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "authoring/import/character_package.h"
#include "authoring/paint/surface_texels.h"
#include "character/package/package.h"
#include "rig/rig_file.h"
#include "toy_folder.h"

namespace furrow::authoring {
namespace {

ImportOptions ToyOptions(const ToyFolder& folder) {
  ImportOptions options;
  options.rig = folder.rig();
  options.texture_size = 128;
  return options;
}

TEST(ImportMakeHuman, ImportsTheToyFolder) {
  const ToyFolder folder;
  ImportReport report;
  const Result<character::Character> character =
      ImportMakeHuman(folder.path(), ToyOptions(folder), &report);
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  EXPECT_EQ(report.joints, character->skeleton.num_joints());
  EXPECT_EQ(report.hidden_faces, 2 * 24);  // three rows of vertices enclose two rows of faces
  // The vertices of the cap and the ball have weights. Helpers of joints and eyes have none.
  EXPECT_EQ(report.unweighted_vertices, 2 * report.joints + 16);
  ASSERT_EQ(character->meshes.size(), 5u);
  EXPECT_EQ(character->meshes[0].name, "skin");
  EXPECT_EQ(character->meshes[0].indices.size(), 3u * 2 * 24 * 14);
  EXPECT_EQ(character->meshes[3].name, "hair");
  EXPECT_EQ(character->meshes[4].name, "clothes");
  EXPECT_EQ(character->materials[static_cast<std::size_t>(character->meshes[4].material)].kind,
            character::Material::Kind::kCloth);
  EXPECT_GE(character->FindRigPicture("face_masks_a"), 0);
  EXPECT_GE(character->FindRigPicture("face_squash"), 0);
}

// Locks lie close to the scalp, follow the head, and are the same in every import.
TEST(ImportMakeHuman, HairGrowsFromTheScalp) {
  const ToyFolder folder;
  const Result<character::Character> first = ImportMakeHuman(folder.path(), ToyOptions(folder));
  const Result<character::Character> second = ImportMakeHuman(folder.path(), ToyOptions(folder));
  ASSERT_TRUE(first.ok() && second.ok());
  const character::Mesh& hair = first->meshes[3];
  ASSERT_GT(hair.vertices.size(), 100u);
  ASSERT_EQ(hair.vertices.size(), second->meshes[3].vertices.size());
  for (std::size_t v = 0; v < hair.vertices.size(); ++v) {
    const character::Vertex& vertex = hair.vertices[v];
    EXPECT_EQ(vertex.position, second->meshes[3].vertices[v].position);
    EXPECT_EQ(vertex.joints[0], first->skeleton.Find("head"));
    float nearest = 1.0f;
    for (const character::Vertex& skin : first->meshes[0].vertices) {
      nearest = std::min(nearest, glm::distance(skin.position, vertex.position));
    }
    EXPECT_LT(nearest, 0.05f);
  }
  // With the opposite winding, locks would be lit from inside the head.
  for (std::size_t i = 0; i < hair.indices.size(); i += 3) {
    const character::Vertex& a = hair.vertices[hair.indices[i]];
    const character::Vertex& b = hair.vertices[hair.indices[i + 1]];
    const character::Vertex& c = hair.vertices[hair.indices[i + 2]];
    const glm::vec3 outward = glm::cross(b.position - a.position, c.position - a.position);
    EXPECT_GE(glm::dot(outward, a.normal + b.normal + c.normal), 0.0f) << i;
  }
}

TEST(ImportMakeHuman, VerticesAreMetresUnitAndFaceOutwards) {
  const ToyFolder folder;
  const Result<character::Character> character = ImportMakeHuman(folder.path(), ToyOptions(folder));
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  const character::Mesh& skin = character->meshes[0];
  float lowest = 1.0f, highest = 0.0f;
  for (const character::Vertex& vertex : skin.vertices) {
    lowest = std::min(lowest, vertex.position.y);
    highest = std::max(highest, vertex.position.y);
    EXPECT_NEAR(glm::length(vertex.normal), 1.0f, 1e-4f);
    EXPECT_NEAR(glm::dot(vertex.normal, glm::vec3(vertex.tangent)), 0.0f, 1e-3f);
    EXPECT_EQ(std::abs(vertex.tangent.w), 1.0f);
    EXPECT_FLOAT_EQ(vertex.skin_weights[0] + vertex.skin_weights[1] + vertex.skin_weights[2] +
                        vertex.skin_weights[3],
                    1.0f);
    EXPECT_EQ(vertex.joints[0], character->skeleton.Find("head"));
    EXPECT_TRUE(vertex.uv.x >= 0 && vertex.uv.x <= 1 && vertex.uv.y >= 0 && vertex.uv.y <= 1);
  }
  EXPECT_NEAR(lowest, 0.0f, 1e-6f);
  EXPECT_GT(highest, 0.15f);
  EXPECT_LT(highest, 0.2f);
  const glm::vec3 centre(0.0f, 0.1f, 0.0f);
  for (std::size_t i = 0; i < skin.indices.size(); i += 3) {
    const glm::vec3 a = skin.vertices[skin.indices[i]].position;
    const glm::vec3 b = skin.vertices[skin.indices[i + 1]].position;
    const glm::vec3 c = skin.vertices[skin.indices[i + 2]].position;
    EXPECT_GT(glm::dot(glm::cross(b - a, c - a), a + b + c - 3.0f * centre), 0.0f);
  }
}

TEST(ImportMakeHuman, NormalsAreContinuousAcrossUvSeams) {
  const ToyFolder folder;
  const Result<character::Character> character = ImportMakeHuman(folder.path(), ToyOptions(folder));
  ASSERT_TRUE(character.ok());
  std::set<std::tuple<float, float, float>> positions, normals;
  for (const character::Vertex& v : character->meshes[0].vertices) {
    positions.emplace(v.position.x, v.position.y, v.position.z);
    normals.emplace(v.normal.x, v.normal.y, v.normal.z);
  }
  EXPECT_LT(positions.size(), character->meshes[0].vertices.size());  // the seam was split
  EXPECT_EQ(normals.size(), positions.size());
}

// In the picture, each region covers its side of the face and not the other side.
TEST(ImportMakeHuman, MasksAreOnTheCorrectSide) {
  const ToyFolder folder;
  const Result<character::Character> character = ImportMakeHuman(folder.path(), ToyOptions(folder));
  ASSERT_TRUE(character.ok());
  const character::Picture& mask =
      character->pictures[static_cast<std::size_t>(character->FindRigPicture("face_masks_a"))];
  int left = 0, right = 0, sum_over = 0;
  for (const SurfaceTexel& texel :
       RasterizeSurface(character->meshes[0], mask.width, mask.height)) {
    const std::uint8_t* p =
        &mask.pixels[static_cast<std::size_t>(texel.y * mask.width + texel.x) * 4];
    (texel.position.x > 0.011f ? left : right) +=
        texel.position.x > 0.011f || texel.position.x < -0.011f ? p[0] : 0;
    sum_over += p[0] + p[1] + p[2] + p[3] > 257 ? 1 : 0;
  }
  EXPECT_GT(left, 1000);
  EXPECT_EQ(right, 0);
  EXPECT_EQ(sum_over, 0);
}

TEST(ImportMakeHuman, MissingClothesAreAWarning) {
  const ToyFolder folder;
  folder.Remove("clothes/cap/cap.mhclo");
  ImportReport report;
  const Result<character::Character> character =
      ImportMakeHuman(folder.path(), ToyOptions(folder), &report);
  ASSERT_TRUE(character.ok()) << character.status().ToString();
  EXPECT_EQ(report.hidden_faces, 0);
  EXPECT_EQ(character->meshes.size(), 4u);
  EXPECT_NE(report.warnings.front().find("no clothes"), std::string::npos);
}

TEST(ImportMakeHuman, EachMissingFileIsNamed) {
  for (const char* file : {"3dobjs/base.obj", "rigs/default.mhskel", "rigs/default_weights.mhw",
                           "clothes/cap/cap.obj", "toy.rig.json"}) {
    const ToyFolder folder;
    folder.Remove(file);
    const Status status = ImportMakeHuman(folder.path(), ToyOptions(folder)).status();
    EXPECT_EQ(status.code(), StatusCode::kNotFound) << file;
    EXPECT_EQ(status.where(), (folder.path() / file).string());
  }
}

TEST(ImportMakeHuman, EachGarbledFileIsNamed) {
  for (const char* file : {"3dobjs/base.obj", "rigs/default.mhskel", "rigs/default_weights.mhw",
                           "clothes/cap/cap.obj", "clothes/cap/cap.mhclo", "toy.rig.json"}) {
    const ToyFolder folder;
    folder.Write(file, "\x01garbage\xff\n");
    const Status status = ImportMakeHuman(folder.path(), ToyOptions(folder)).status();
    EXPECT_FALSE(status.ok()) << file;
    EXPECT_EQ(status.where().rfind((folder.path() / file).string(), 0), 0u) << status.ToString();
  }
}

TEST(ImportMakeHuman, RejectsInconsistentFiles) {
  const ToyFolder folder;
  folder.Write("clothes/cap/cap.mhclo", "obj_file cap.obj\nverts 0\n1\n2\n");
  Status status = ImportMakeHuman(folder.path(), ToyOptions(folder)).status();
  EXPECT_EQ(status.code(), StatusCode::kSchema);
  EXPECT_NE(status.what().find("has 3"), std::string::npos) << status.ToString();

  const ToyFolder other;
  std::string rig = other.Read("toy.rig.json");
  for (std::size_t at; (at = rig.find("oculi01.L")) != std::string::npos;)
    rig.replace(at, 9, "tail");
  other.Write("toy.rig.json", rig);
  status = ImportMakeHuman(other.path(), ToyOptions(other)).status();
  EXPECT_EQ(status.code(), StatusCode::kNotFound);
  EXPECT_NE(status.ToString().find("tail"), std::string::npos);
}

TEST(ImportMakeHuman, RejectsNumbersThatAreTooLarge) {
  const ToyFolder folder;
  folder.Write("clothes/cap/cap.obj",
               "v 0 0 0\nv 0 0 0\nv 0 0 0\nvt 0 0\nvt 1e30 0\nvt 0 1\nf 1/1 2/2 3/3\n");
  Status status = ImportMakeHuman(folder.path(), ToyOptions(folder)).status();
  EXPECT_EQ(status.code(), StatusCode::kLimit);
  EXPECT_EQ(status.where(), (folder.path() / "clothes/cap/cap.obj").string() + ":5");

  const ToyFolder other;
  other.Write("clothes/cap/cap.mhclo", "obj_file cap.obj\nverts 0\n1\n2\n0 8 16 1e30 0 0 0 0 0\n");
  status = ImportMakeHuman(other.path(), ToyOptions(other)).status();
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_NE(status.what().find("away from the body"), std::string::npos);
}

TEST(ImportMakeHuman, RejectsAMissingFaceJoint) {
  const ToyFolder folder;
  std::string skeleton = folder.Read("rigs/default.mhskel");
  skeleton.replace(skeleton.find("\"levator05.R\""), 13, "\"levator99.R\"");
  folder.Write("rigs/default.mhskel", skeleton);
  const Status status = ImportMakeHuman(folder.path(), ToyOptions(folder)).status();
  EXPECT_EQ(status.code(), StatusCode::kNotFound);
  EXPECT_NE(status.what().find("levator05.R"), std::string::npos);
}

TEST(ImportMakeHuman, TextureSizeIsChecked) {
  const ToyFolder folder;
  ImportOptions options = ToyOptions(folder);
  for (const int size : {63, 4097, -1}) {
    options.texture_size = size;
    EXPECT_EQ(ImportMakeHuman(folder.path(), options).status().code(),
              StatusCode::kInvalidArgument);
  }
}

TEST(ImportMakeHuman, PackageIsWrittenAtomically) {
  const ToyFolder folder;
  Result<character::Character> character = ImportMakeHuman(folder.path(), ToyOptions(folder));
  ASSERT_TRUE(character.ok());
  const std::filesystem::path glb = folder.path() / "whole.glb";
  std::filesystem::create_directory(folder.path() / "whole.rig.json");
  EXPECT_EQ(WriteCharacterPackage(*character, glb).code(), StatusCode::kIo);
  EXPECT_FALSE(std::filesystem::exists(glb));
  std::filesystem::remove(folder.path() / "whole.rig.json");
  character->rig.wrinkle_maps[0].derivative_scale = 700.0f;
  const Status refused = WriteCharacterPackage(*character, glb);
  EXPECT_EQ(refused.code(), StatusCode::kInvalidArgument);
  EXPECT_NE(refused.where().find("whole.rig.json: wrinkle_maps[0]"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(glb));
}

TEST(ImportMakeHuman, PackageReadsBackWithTheSameRig) {
  const ToyFolder folder;
  const Result<character::Character> character = ImportMakeHuman(folder.path(), ToyOptions(folder));
  ASSERT_TRUE(character.ok());
  const std::filesystem::path glb = folder.path() / "toy.glb";
  const Status written = WriteCharacterPackage(*character, glb);
  ASSERT_TRUE(written.ok()) << written.ToString();
  std::filesystem::remove(folder.rig());  // has the same name as the rig of the package
  ASSERT_TRUE(WriteCharacterPackage(*character, glb).ok());
  const Result<character::Character> loaded = character::LoadCharacter(glb);
  ASSERT_TRUE(loaded.ok()) << loaded.status().ToString();
  EXPECT_EQ(rig::RigToJson(loaded->rig), rig::RigToJson(character->rig));
  EXPECT_EQ(loaded->skeleton.num_joints(), character->skeleton.num_joints());
  EXPECT_EQ(loaded->meshes.size(), character->meshes.size());
  EXPECT_GE(loaded->FindRigPicture("face_masks_a"), 0);
  EXPECT_GE(loaded->FindRigPicture("face_squash"), 0);
}

}  // namespace
}  // namespace furrow::authoring
