// SPDX-License-Identifier: Apache-2.0
#include "authoring/assimp/shape_groups.h"

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow::authoring {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// A mesh of two vertices; each shape moves the first by `z`.
class FaceMesh {
 public:
  explicit FaceMesh(const std::vector<std::pair<const char*, float>>& shapes) {
    mesh_.mNumVertices = 2;
    mesh_.mVertices = new aiVector3D[2]{{1, 2, 3}, {4, 5, 6}};
    mesh_.mNumAnimMeshes = static_cast<unsigned>(shapes.size());
    mesh_.mAnimMeshes = new aiAnimMesh*[shapes.size()];
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      auto* shape = mesh_.mAnimMeshes[i] = new aiAnimMesh;
      shape->mName.Set(shapes[i].first);
      shape->mNumVertices = 2;
      shape->mVertices = new aiVector3D[2]{{1, 2, 3.0f + shapes[i].second}, {4, 5, 6}};
    }
  }

  [[nodiscard]] const aiMesh& mesh() const { return mesh_; }

  // Name -> z of the first vertex, for all targets.
  [[nodiscard]] std::vector<std::pair<std::string, float>> Targets(
      std::vector<std::string>* remarks) const {
    std::vector<std::pair<std::string, float>> targets;
    for (const ShapeGroup& group : GroupShapes(mesh_)) {
      for (const NamedDeltas& target : TargetsOf(group, mesh_, remarks)) {
        EXPECT_EQ(target.deltas[1], glm::vec3(0.0f));
        targets.emplace_back(target.name, target.deltas[0].z);
      }
    }
    return targets;
  }

 private:
  aiMesh mesh_;  // deletes what it points to
};

TEST(ShapeGroups, SeparateShapesStaySeparate) {
  std::vector<std::string> remarks;
  const FaceMesh face({{"a", 1.0f}, {"b", 2.0f}, {"", 3.0f}, {"", 4.0f}, {"a", 5.0f}});
  EXPECT_THAT(face.Targets(&remarks),
              ElementsAre(std::pair("a", 1.0f), std::pair("b", 2.0f), std::pair("", 3.0f),
                          std::pair("", 4.0f), std::pair("a", 5.0f)));
  EXPECT_THAT(remarks, IsEmpty());
}

// The whole shape moves by 8. On the way it passes 1 and 6 instead of 2.64 and 5.36.
TEST(ShapeGroups, InBetweensBecomeCorrectives) {
  for (const std::vector<std::pair<const char*, float>>& order :
       {std::vector<std::pair<const char*, float>>{
            {"blink", 1.0f}, {"blink", 6.0f}, {"blink", 8.0f}, {"jaw", 1.0f}},
        {{"blink", 8.0f}, {"blink", 6.0f}, {"blink", 1.0f}, {"jaw", 1.0f}}}) {
    std::vector<std::string> remarks;
    const auto targets = FaceMesh(order).Targets(&remarks);
    ASSERT_EQ(targets.size(), 4u);
    EXPECT_EQ(targets[0], std::pair(std::string("blink"), 8.0f));
    EXPECT_EQ(targets[1].first, "blink33");
    EXPECT_NEAR(targets[1].second + 0.33f * 8.0f, 1.0f, 1e-5f);
    EXPECT_EQ(targets[2].first, "blink67");
    EXPECT_NEAR(targets[2].second + 0.67f * 8.0f, 6.0f, 1e-5f);
    EXPECT_EQ(targets[3].first, "jaw");
    EXPECT_THAT(remarks, ElementsAre(HasSubstr("'blink' has 2 in-betweens; the weights in the file "
                                               "are unknown, and 33, 67 % are used")));
  }
}

TEST(ShapeGroups, NamesThatEndWithADigitHaveNoCorrectives) {
  std::vector<std::string> remarks;
  const FaceMesh face({{"AU12", 1.0f}, {"AU12", 2.0f}});
  EXPECT_THAT(face.Targets(&remarks), ElementsAre(std::pair("AU12", 2.0f)));
  EXPECT_THAT(remarks, ElementsAre(HasSubstr("'AU12' has 1 in-between, left out")));
}

TEST(ShapeGroups, ShapesOfAnotherMeshAreSkipped) {
  std::vector<std::string> remarks;
  const FaceMesh face({{"a", 1.0f}, {"b", 2.0f}});
  face.mesh().mAnimMeshes[0]->mNumVertices = 1;
  EXPECT_EQ(GroupShapes(face.mesh()).size(), 2u);  // its channel still counts
  EXPECT_THAT(face.Targets(&remarks), ElementsAre(std::pair("b", 2.0f)));
}

}  // namespace
}  // namespace furrow::authoring
