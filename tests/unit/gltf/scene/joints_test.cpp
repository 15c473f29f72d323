// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/joints.h"

#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gltf/limits.h"
#include "tests/unit/gltf/gltf_testing.h"

namespace furrow::gltf {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// A document with these nodes, and its forest.
struct Scene {
  explicit Scene(const json& nodes) {
    HandMadeGltf gltf = TwoJoints();
    gltf.json["nodes"] = nodes;
    bytes = gltf.Glb();
    document = Document::Open(bytes, {});
    EXPECT_TRUE(document.ok()) << document.status().ToString();
    Result<NodeForest> read = ReadNodes(&*document);
    EXPECT_TRUE(read.ok()) << read.status().ToString();
    if (read.ok()) forest = *read;
  }
  JointList List(const std::vector<std::pair<std::string, int>>& names = {}) {
    NodeSet all(forest);
    all.AddAll();
    return ListJoints(forest, all, names, &*document);
  }
  std::string bytes;
  Result<Document> document = Status(StatusCode::kInternal, "not opened");
  NodeForest forest;
};

std::vector<std::string> NamesOf(const JointList& list) {
  std::vector<std::string> names;
  for (const Joint& joint : list.joints) names.push_back(joint.name);
  return names;
}

TEST(NodeSet, AddsAncestorsAndTrees) {
  const Scene scene(json::array({{{"children", {1, 2}}},
                                 json::object(),
                                 {{"children", {3}}},
                                 json::object(),
                                 json::object()}));
  NodeSet set(scene.forest);
  set.AddWithAncestors(3);
  EXPECT_TRUE(set.Has(0) && set.Has(2) && set.Has(3));
  EXPECT_FALSE(set.Has(1) || set.Has(4));
  set.Remove(3);
  EXPECT_FALSE(set.Has(3));
  NodeSet tree(scene.forest);
  tree.AddTree(3);
  EXPECT_TRUE(tree.Has(0) && tree.Has(1) && tree.Has(2) && tree.Has(3));
  EXPECT_FALSE(tree.Has(4));
}

TEST(FindRigidParts, LeadToMeshesBelowTheSet) {
  Scene scene(json::array({{{"name", "root"}, {"children", {1, 2, 5}}},
                           {{"name", "joint"}},
                           {{"name", "eye"}, {"children", {3, 4}}},
                           {{"name", "ball"}},
                           {{"name", "empty"}},
                           {{"name", "skinned"}},
                           {{"name", "elsewhere"}, {"children", {7}}},
                           {{"name", "prop"}}}));
  for (const int node : {1, 3, 5, 7}) scene.forest.nodes[static_cast<std::size_t>(node)].mesh = 0;
  scene.forest.nodes[5].skin = 0;
  NodeSet set(scene.forest);
  set.AddWithAncestors(1);
  EXPECT_THAT(FindRigidParts(scene.forest, set),
              ElementsAre(false, false, true, true, false, false, false, false))
      << "eye and ball";
}

TEST(ListJoints, KeepsTheFilesOrder) {
  Scene scene(json::array({{{"name", "leaf"}}, {{"name", "root"}, {"children", {0}}}}));
  const JointList list = scene.List();
  EXPECT_THAT(NamesOf(list), ElementsAre("leaf", "root"));
  EXPECT_EQ(list.joints[0].parent, 1);
  EXPECT_EQ(list.joints[1].parent, kNone);
  EXPECT_THAT(list.joint_of_node, ElementsAre(0, 1));
}

TEST(ListJoints, MakesNamesUnique) {
  Scene scene(json::array({{{"name", "a"}},
                           {{"name", "a_2"}},
                           {{"name", "a"}},
                           {{"name", "a"}},
                           json::object(),
                           {{"name", "hips"}},
                           {{"name", "pelvis"}}}));
  const JointList list = scene.List({{"hips", 6}});
  EXPECT_THAT(NamesOf(list), ElementsAre("a", "a_2", "a_3", "a_4", "node_4", "hips_2", "hips"));
  EXPECT_EQ(list.num_nameless, 1);
  EXPECT_THAT(scene.document->warnings(),
              ElementsAre(HasSubstr("nodes[2].name"), HasSubstr("nodes[3].name")));
}

// Maps ignore case, so "Hips" would pass for the node that the file calls the hips.
TEST(ListJoints, LeavesGivenNamesToTheirNodes) {
  Scene scene(json::array({{{"name", "Hips"}}, {{"name", "HIPS_2"}}, {{"name", "Bone"}}}));
  EXPECT_THAT(NamesOf(scene.List({{"hips", 2}})), ElementsAre("Hips_2", "HIPS_2", "hips"));
  EXPECT_THAT(scene.document->warnings(), ElementsAre());
}

TEST(ListJoints, CutsLongNamesBetweenCharacters) {
  std::string name(kMaxNameBytes - 1, 'x');
  name += "\xC3\xA4";  // two bytes around the limit
  Scene scene(json::array({{{"name", name}}}));
  EXPECT_THAT(NamesOf(scene.List()), ElementsAre(std::string(kMaxNameBytes - 1, 'x')));
  EXPECT_THAT(scene.document->warnings(), ElementsAre(HasSubstr("is cut")));
}

TEST(ListJoints, ReadsTails) {
  Scene scene(json::array({{{"extras", {{"furrow_tail", {1, 2, 3}}}}},
                           {{"extras", {{"furrow_tail", {1, 2}}}}},
                           {{"extras", {{"furrow_tail", {1, 2, 1e300}}}}},
                           {{"extras", 5}}}));
  const JointList list = scene.List();
  EXPECT_EQ(list.joints[0].tail, glm::vec3(1, 2, 3));
  for (std::size_t j = 1; j < 4; ++j) EXPECT_FALSE(list.joints[j].tail) << j;
}

TEST(ListJoints, ReadsRoles) {
  Scene scene(json::array({{{"extras", {{"furrow_role", "hips"}}}},
                           {{"extras", {{"furrow_role", nullptr}}}},
                           {{"extras", 5}}}));
  const JointList list = scene.List();
  EXPECT_EQ(list.joints[0].role, "hips");
  for (std::size_t j = 1; j < 3; ++j) EXPECT_EQ(list.joints[j].role, "") << j;
}

}  // namespace
}  // namespace furrow::gltf
