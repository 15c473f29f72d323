// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/formats/mhskel.h"

#include <memory>
#include <string>

#include <gtest/gtest.h>

namespace furrow::authoring {
namespace {

// "a.tip" precedes its parent, because MakeHuman's files are in alphabetical order.
constexpr char kSkeleton[] = R"({
  "bones": {
    "a.tip": {"parent": "root", "head": "mid", "tail": "top"},
    "root": {"parent": null, "head": "low", "tail": "mid"}
  },
  "joints": {"low": [0, 1], "mid": [2], "top": [3]}
})";
const std::vector<glm::vec3> kPositions{{-1, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 3, 1}};

TEST(ImportMhskel, HeadsAreMeansAndAxesAreModelAxes) {
  const Result<MhSkeleton> parsed = ParseMhskel(kSkeleton, "toy.mhskel");
  ASSERT_TRUE(parsed.ok()) << parsed.status().ToString();
  const Result<wrinkle::Skeleton> skeleton = BuildSkeleton(*parsed, kPositions, "toy.mhskel");
  ASSERT_TRUE(skeleton.ok()) << skeleton.status().ToString();
  const int root = skeleton->Find("root"), tip = skeleton->Find("a.tip");
  ASSERT_EQ(root, 0);
  ASSERT_EQ(tip, 1);
  EXPECT_EQ(skeleton->joint_parents()[1], 0);
  EXPECT_EQ(skeleton->rest_pose()[0].translation, glm::vec3(0, 0, 0));
  EXPECT_EQ(skeleton->rest_pose()[1].translation, glm::vec3(0, 2, 0));
  EXPECT_EQ(skeleton->rest_pose()[1].rotation, glm::quat(1, 0, 0, 0));
  EXPECT_EQ(skeleton->tails()[1], glm::vec3(0, 1, 1));
}

TEST(ImportMhskel, RejectsVerticesOfAnotherMesh) {
  const Result<MhSkeleton> parsed = ParseMhskel(kSkeleton, "toy.mhskel");
  ASSERT_TRUE(parsed.ok());
  const Status status =
      BuildSkeleton(*parsed, std::span(kPositions).first(3), "toy.mhskel").status();
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(status.where(), "toy.mhskel: a.tip");
}

TEST(ImportMhskel, RejectsMissingAndCyclicParents) {
  MhSkeleton skeleton;
  skeleton.joints = {{"a", "b", {0}, {1}}, {"b", "a", {0}, {1}}};
  EXPECT_EQ(BuildSkeleton(skeleton, kPositions, "x").status().code(), StatusCode::kCyclic);
  skeleton.joints[1].parent = "c";
  EXPECT_EQ(BuildSkeleton(skeleton, kPositions, "x").status().code(), StatusCode::kNotFound);
}

struct BadSkeleton {
  const char* text;
  StatusCode code;
  const char* where;
};

class ImportMhskelErrors : public testing::TestWithParam<BadSkeleton> {};

TEST_P(ImportMhskelErrors, NameTheField) {
  const Result<MhSkeleton> skeleton = ParseMhskel(GetParam().text, "s");
  ASSERT_FALSE(skeleton.ok());
  EXPECT_EQ(skeleton.status().code(), GetParam().code) << skeleton.status().ToString();
  EXPECT_EQ(skeleton.status().where(), GetParam().where);
}

INSTANTIATE_TEST_SUITE_P(
    Each, ImportMhskelErrors,
    testing::Values(
        BadSkeleton{"", StatusCode::kParse, "s:1"},
        BadSkeleton{"{\n\"bones\": ,\n}", StatusCode::kParse, "s:2"},
        BadSkeleton{"[]", StatusCode::kSchema, "s: (whole file)"},
        BadSkeleton{R"({"joints": {}})", StatusCode::kSchema, "s: bones"},
        BadSkeleton{R"({"bones": [], "joints": {}})", StatusCode::kSchema, "s: bones"},
        BadSkeleton{R"({"bones": {}})", StatusCode::kSchema, "s: joints"},
        BadSkeleton{R"({"bones": {"a": 1}, "joints": {}})", StatusCode::kSchema, "s: bones.a"},
        BadSkeleton{R"({"bones": {"a": {"parent": 3}}, "joints": {}})", StatusCode::kSchema,
                    "s: bones.a.parent"},
        BadSkeleton{R"({"bones": {"a": {"parent": null}}, "joints": {}})", StatusCode::kSchema,
                    "s: bones.a.head"},
        BadSkeleton{R"({"bones": {"a": {"parent": null, "head": "h"}}, "joints": {}})",
                    StatusCode::kNotFound, "s: bones.a.head"},
        BadSkeleton{R"({"bones": {"a": {"parent": null, "head": "h"}}, "joints": {"h": []}})",
                    StatusCode::kSchema, "s: joints.h"},
        BadSkeleton{R"({"bones": {"a": {"parent": null, "head": "h"}}, "joints": {"h": [-1]}})",
                    StatusCode::kSchema, "s: joints.h"},
        BadSkeleton{
            R"({"bones": {"a": {"parent": null, "head": "h"}}, "joints": {"h": [4294967296]}})",
            StatusCode::kSchema, "s: joints.h"}));

TEST(ImportMhw, ReadsWeightsAndRejectsInvalidOnes) {
  const Result<MhWeights> weights = ParseMhw(R"({"weights": {"a": [[3, 0.25], [7, 1]]}})", "w");
  ASSERT_TRUE(weights.ok()) << weights.status().ToString();
  ASSERT_EQ(weights->joints.size(), 1u);
  EXPECT_EQ(weights->joints[0].vertices[0], std::make_pair(3u, 0.25f));
  const auto code = [](const char* list) {
    return ParseMhw(std::string(R"({"weights": {"a": )") + list + "}}", "w").status().code();
  };
  EXPECT_EQ(code("3"), StatusCode::kSchema);
  EXPECT_EQ(code("[3]"), StatusCode::kSchema);
  EXPECT_EQ(code("[[3]]"), StatusCode::kSchema);
  EXPECT_EQ(code("[[3, \"x\"]]"), StatusCode::kSchema);
  EXPECT_EQ(code("[[-3, 0.5]]"), StatusCode::kSchema);
  EXPECT_EQ(code("[[3, 1.5]]"), StatusCode::kInvalidArgument);
  EXPECT_EQ(code("[[3, -0.5]]"), StatusCode::kInvalidArgument);
  EXPECT_EQ(code("[[3, 1e999]]"), StatusCode::kParse);
  EXPECT_EQ(code("[[3, NaN]]"), StatusCode::kParse);
  EXPECT_EQ(ParseMhw("{}", "w").status().where(), "w: weights");
}

TEST(ImportMhskel, RejectsEveryTruncation) {
  const std::string text = kSkeleton;
  for (std::size_t length = 0; length < text.size(); ++length) {
    const std::unique_ptr<char[]> copy(new char[length]);
    text.copy(copy.get(), length);
    EXPECT_FALSE(ParseMhskel({copy.get(), length}, "cut").ok()) << length;
    EXPECT_FALSE(ParseMhw({copy.get(), length}, "cut").ok()) << length;
  }
}

TEST(ImportMhskel, RejectsDeepNesting) {
  EXPECT_EQ(ParseMhskel(std::string(200'000, '['), "deep").status().code(), StatusCode::kParse);
}

}  // namespace
}  // namespace furrow::authoring
