// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/vrm_humanoid.h"

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/gltf/gltf_testing.h"

namespace furrow::gltf {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;
using Bones = std::vector<std::pair<std::string, int>>;

struct BonesRead {
  Bones bones;
  std::vector<std::string> warnings;
};

BonesRead BonesOf(const HandMadeGltf& gltf) {
  const std::string glb = gltf.Glb();
  Result<Document> document = Document::Open(glb, {});
  EXPECT_TRUE(document.ok()) << document.status().ToString();
  if (!document.ok()) return {};
  Bones bones = ReadVrmHumanoid(&*document);
  return {std::move(bones), document->warnings()};
}

TEST(VrmHumanoid, OfVrm1) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"] = {
      {"hips", {{"node", 0}}}, {"leftThumbProximal", {{"node", 1}}}, {"tail", {{"node", 1}}}};
  const BonesRead read = BonesOf(gltf);
  EXPECT_THAT(read.bones,
              UnorderedElementsAre(Pair("hips", 0), Pair("leftThumbProximal", 1), Pair("tail", 1)));
  EXPECT_THAT(read.warnings, IsEmpty());
}

// The proximal bone of a thumb became its metacarpal bone in VRM 1.0.
TEST(VrmHumanoid, OfVrm0) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["extensions"]["VRM"]["humanoid"]["humanBones"] = {
      {{"bone", "hips"}, {"node", 0}},
      {{"bone", "rightThumbProximal"}, {"node", 1}},
      {{"bone", "rightThumbIntermediate"}, {"node", 1}},
      {{"bone", "rightThumbDistal"}, {"node", 1}},
      {{"bone", "leftEye"}, {"node", -1}}};
  const BonesRead read = BonesOf(gltf);
  EXPECT_THAT(read.bones, ElementsAre(Pair("hips", 0), Pair("rightThumbMetacarpal", 1),
                                      Pair("rightThumbProximal", 1), Pair("rightThumbDistal", 1)));
  EXPECT_THAT(read.warnings, IsEmpty());
}

TEST(VrmHumanoid, LeavesOutWhatIsWrong) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["extensions"]["VRM"]["humanoid"]["humanBones"] = {{{"bone", "hips"}, {"node", 7000}},
                                                              {{"bone", "spine"}, {"node", "0"}},
                                                              {{"bone", "head"}, {"node", 0}},
                                                              {{"bone", "head"}, {"node", 1}},
                                                              9};
  const BonesRead read = BonesOf(gltf);
  EXPECT_THAT(read.bones, ElementsAre(Pair("head", 0)));
  EXPECT_EQ(read.warnings.size(), 4u);
}

// Editors that match joints by their place take a joint of the hair for the jaw.
TEST(VrmHumanoid, AJawIsCalledOne) {
  HandMadeGltf gltf = TwoJoints();
  gltf.json["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"] = {{"jaw", {{"node", 1}}}};
  gltf.json["nodes"][1]["name"] = "Hair_front_01";
  const BonesRead read = BonesOf(gltf);
  EXPECT_THAT(read.bones, IsEmpty());
  EXPECT_THAT(read.warnings, ElementsAre(HasSubstr("not called a jaw")));
  gltf.json["nodes"][1]["name"] = "c_JawBone";
  EXPECT_THAT(BonesOf(gltf).bones, ElementsAre(Pair("jaw", 1)));
}

TEST(VrmHumanoid, OfOtherFiles) {
  HandMadeGltf gltf = TwoJoints();
  EXPECT_THAT(BonesOf(gltf).bones, IsEmpty());
  gltf.json["extensions"]["VRMC_vrm"] = 7;
  EXPECT_THAT(BonesOf(gltf).bones, IsEmpty());
}

}  // namespace
}  // namespace furrow::gltf
