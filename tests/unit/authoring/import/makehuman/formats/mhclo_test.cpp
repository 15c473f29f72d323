// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/formats/mhclo.h"

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "authoring/import/makehuman/skin_weights.h"

namespace furrow::authoring {
namespace {

constexpr char kGarment[] =
    "# comment\n"
    "name shirt\n"
    "obj_file shirt.obj\n"
    "x_scale 0 1 4.0\n"
    "z_depth 50\n"
    "verts 0\n"
    "0 1 2 0.5 0.25 0.25 1 1 1\n"
    "3\n"
    "\n"
    "delete_verts\n"
    "0 2 - 3 \n";
const std::vector<glm::vec3> kBase{{-1, 0, 0}, {1, 0, 0}, {0, 4, 0}, {0, 0, 8}};

// Several of MakeHuman's hairs name their material between 'verts' and the first vertex.
TEST(ImportMhclo, KeywordsDoNotEndASection) {
  const Result<Mhclo> garment = ParseMhclo(
      "obj_file a.obj\nverts 0\nmaterial my hair.mhmat\n1\nz_depth 70\n2\nweights head\n"
      "0 0.5\ndelete_verts\ntag x\n3\n",
      "g", kBase.size());
  ASSERT_TRUE(garment.ok()) << garment.status().ToString();
  EXPECT_EQ(garment->vertices.size(), 2u);
  EXPECT_EQ(garment->material, "my hair.mhmat");
  EXPECT_EQ(garment->z_depth, 70);
  EXPECT_EQ(garment->deleted, (std::vector<bool>{false, false, false, true}));
}

TEST(ImportMhclo, FitsByBarycentricWeightsAndScaledOffsets) {
  const Result<Mhclo> garment = ParseMhclo(kGarment, "g", kBase.size());
  ASSERT_TRUE(garment.ok()) << garment.status().ToString();
  EXPECT_EQ(garment->name, "shirt");
  EXPECT_EQ(garment->obj_file, "shirt.obj");
  EXPECT_EQ(garment->deleted, (std::vector<bool>{true, false, true, true}));
  const std::vector<glm::vec3> fitted = FitGarment(*garment, kBase);
  ASSERT_EQ(fitted.size(), 2u);
  // x = -0.5 + 0.25 + offset 1 scaled by |-1 - 1| / 4; y = 0.25 * 4 + 1; z = 1.
  EXPECT_EQ(fitted[0], glm::vec3(0.25f, 2.0f, 1.0f));
  EXPECT_EQ(fitted[1], kBase[3]);
}

TEST(ImportMhclo, GarmentScalesWithTheBody) {
  std::string text = kGarment;
  text.replace(text.find("z_depth"), 7, "y_scale 0 2 4\nz_scale 0 3 8\nz_depth");
  const Result<Mhclo> garment = ParseMhclo(text, "g", kBase.size());
  ASSERT_TRUE(garment.ok()) << garment.status().ToString();
  std::vector<glm::vec3> twice = kBase;
  for (glm::vec3& p : twice) p *= 2.0f;
  const std::vector<glm::vec3> once = FitGarment(*garment, kBase);
  const std::vector<glm::vec3> fitted = FitGarment(*garment, twice);
  for (std::size_t i = 0; i < once.size(); ++i) EXPECT_EQ(fitted[i], 2.0f * once[i]);
}

struct BadGarment {
  const char* text;
  StatusCode code;
  const char* where;
};

class ImportMhcloErrors : public testing::TestWithParam<BadGarment> {};

TEST_P(ImportMhcloErrors, NameTheLine) {
  const Result<Mhclo> garment = ParseMhclo(GetParam().text, "g", 4);
  ASSERT_FALSE(garment.ok());
  EXPECT_EQ(garment.status().code(), GetParam().code) << garment.status().ToString();
  EXPECT_EQ(garment.status().where(), GetParam().where);
}

INSTANTIATE_TEST_SUITE_P(
    Each, ImportMhcloErrors,
    testing::Values(BadGarment{"", StatusCode::kSchema, "g"},
                    BadGarment{"obj_file a.obj\n", StatusCode::kSchema, "g"},
                    BadGarment{"verts 0\n1\n", StatusCode::kSchema, "g"},
                    BadGarment{"obj_file ../a.obj\n", StatusCode::kSchema, "g:1"},
                    BadGarment{"obj_file /etc/passwd\n", StatusCode::kSchema, "g:1"},
                    BadGarment{"1 2 3\n", StatusCode::kParse, "g:1"},
                    BadGarment{"x_scale 0 1\n", StatusCode::kParse, "g:1"},
                    BadGarment{"x_scale 0 4 1\n", StatusCode::kInvalidArgument, "g:1"},
                    BadGarment{"x_scale 0 1 0\n", StatusCode::kSchema, "g:1"},
                    BadGarment{"x_scale 0 1 nan\n", StatusCode::kNonFinite, "g:1"},
                    BadGarment{"verts 0\n4\n", StatusCode::kInvalidArgument, "g:2"},
                    BadGarment{"verts 0\n-1\n", StatusCode::kInvalidArgument, "g:2"},
                    BadGarment{"verts 0\n1.5\n", StatusCode::kParse, "g:2"},
                    BadGarment{"verts 0\n0 1 2 .5 .5\n", StatusCode::kParse, "g:2"},
                    BadGarment{"verts 0\n0 1 2 .5 .5 0 0 0 x\n", StatusCode::kParse, "g:2"},
                    BadGarment{"verts 0\n0 1 9 .5 .5 0 0 0 0\n", StatusCode::kInvalidArgument,
                               "g:2"},
                    BadGarment{"verts 0\n0 1 2 .5 inf 0 0 0 0\n", StatusCode::kNonFinite, "g:2"},
                    BadGarment{"delete_verts\n1 -\n", StatusCode::kParse, "g:2"},
                    BadGarment{"delete_verts\n3 - 1\n", StatusCode::kInvalidArgument, "g:2"},
                    BadGarment{"delete_verts\n0 - 4\n", StatusCode::kInvalidArgument, "g:2"}));

TEST(ImportMhclo, TruncatedInputIsReadOrRejected) {
  const std::string text = kGarment;
  for (std::size_t length = 0; length <= text.size(); ++length) {
    const std::unique_ptr<char[]> copy(new char[length]);
    text.copy(copy.get(), length);
    const Result<Mhclo> garment = ParseMhclo({copy.get(), length}, "cut", kBase.size());
    if (garment.ok()) {
      EXPECT_EQ(FitGarment(*garment, kBase).size(), garment->vertices.size());
    }
  }
}

wrinkle::Skeleton SixJoints() {
  std::vector<wrinkle::JointDesc> joints;
  for (int i = 0; i < 6; ++i) {
    wrinkle::JointDesc joint;
    joint.name = std::string(1, static_cast<char>('a' + i));
    joint.parent = i - 1;
    joints.push_back(joint);
  }
  return *wrinkle::Skeleton::Create(joints);
}

TEST(ImportSkinWeights, KeepsAndNormalisesTheFourStrongest) {
  MhWeights weights;
  weights.joints = {{"a", {{0, 0.1f}}},
                    {"b", {{0, 0.2f}}},
                    {"c", {{0, 0.3f}, {2, 0.5f}}},
                    {"d", {{0, 0.4f}}},
                    {"e", {{0, 0.05f}}}};
  const Result<SkinWeights> skin = BindBaseMesh(weights, SixJoints(), 3, "w");
  ASSERT_TRUE(skin.ok());
  EXPECT_EQ(skin->truncated, 1);
  EXPECT_EQ(skin->unweighted, 1);
  const Influences& first = skin->vertices[0];
  EXPECT_EQ(first.joints[0], 3);
  EXPECT_EQ(first.joints[3], 0);
  EXPECT_FLOAT_EQ(first.weights[0], 0.4f);
  EXPECT_FLOAT_EQ(first.weights[3], 0.1f);
  EXPECT_EQ(skin->vertices[1].joints[0], 0);  // without weights: the root
  EXPECT_EQ(skin->vertices[1].weights[0], 1.0f);
  EXPECT_EQ(skin->vertices[2].joints[0], 2);
  EXPECT_EQ(skin->vertices[2].weights[0], 1.0f);
}

TEST(ImportSkinWeights, RejectsUnknownJointsAndVertices) {
  MhWeights weights;
  weights.joints = {{"z", {{0, 1.0f}}}};
  EXPECT_EQ(BindBaseMesh(weights, SixJoints(), 1, "w").status().code(), StatusCode::kNotFound);
  EXPECT_EQ(BindBaseMesh(weights, SixJoints(), 1, "w").status().where(), "w: weights.z");
  weights.joints = {{"a", {{1, 1.0f}}}};
  EXPECT_EQ(BindBaseMesh(weights, SixJoints(), 1, "w").status().code(),
            StatusCode::kInvalidArgument);
}

TEST(ImportSkinWeights, GarmentMixesItsBaseVertices) {
  MhWeights weights;
  weights.joints = {{"a", {{0, 1.0f}}}, {"b", {{1, 1.0f}}}, {"c", {{2, 1.0f}, {3, 1.0f}}}};
  const Result<SkinWeights> base = BindBaseMesh(weights, SixJoints(), 4, "w");
  ASSERT_TRUE(base.ok());
  Mhclo garment;
  garment.vertices.resize(2);
  garment.vertices[0].base = {0, 1, 2};
  garment.vertices[0].weights = {0.5f, 0.75f, -0.25f};  // negative weights are ignored
  garment.vertices[1].base = {2, 3, 0};
  garment.vertices[1].weights = {0.25f, 0.5f, 0.25f};
  const SkinWeights skin = BindGarment(garment, *base);
  EXPECT_EQ(skin.vertices[0].joints[0], 1);
  EXPECT_FLOAT_EQ(skin.vertices[0].weights[0], 0.6f);
  EXPECT_FLOAT_EQ(skin.vertices[0].weights[1], 0.4f);
  EXPECT_EQ(skin.vertices[0].weights[2], 0.0f);
  EXPECT_EQ(skin.vertices[1].joints[0], 2);
  EXPECT_FLOAT_EQ(skin.vertices[1].weights[0], 0.75f);
}

}  // namespace
}  // namespace furrow::authoring
