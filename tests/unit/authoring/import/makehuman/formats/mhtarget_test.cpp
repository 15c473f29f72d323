// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/formats/mhtarget.h"

#include <string>

#include <gtest/gtest.h>

namespace furrow::authoring {
namespace {

TEST(ParseMhTarget, MovesTheListedVertices) {
  const Result<MhTarget> target = ParseMhTarget("# comment\n2 .5 -1 0\n\n0 0 0 2e-1\n", "a", 3);
  ASSERT_TRUE(target.ok()) << target.status().ToString();
  std::vector<glm::vec3> positions(3, glm::vec3(1.0f));
  ApplyMhTarget(*target, 0.5f, positions);
  EXPECT_EQ(positions[0], glm::vec3(1.0f, 1.0f, 1.1f));
  EXPECT_EQ(positions[1], glm::vec3(1.0f));
  EXPECT_EQ(positions[2], glm::vec3(1.25f, 0.5f, 1.0f));
}

TEST(ParseMhTarget, HeaderAloneIsValid) {
  const Result<MhTarget> target = ParseMhTarget("# nothing\n", "a", 3);
  ASSERT_TRUE(target.ok());
  EXPECT_TRUE(target->vertices.empty());
}

TEST(ParseMhTarget, RejectsWithTheLine) {
  const auto status = [](const std::string& text) { return ParseMhTarget(text, "a", 3).status(); };
  EXPECT_EQ(status("0 0 0 0\n3 0 0 0\n").code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(status("0 0 0 0\n3 0 0 0\n").where(), "a:2");
  EXPECT_EQ(status("-1 0 0 0\n").code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(status("x 0 0 0\n").code(), StatusCode::kParse);
  EXPECT_EQ(status("0 0 0\n").code(), StatusCode::kParse);
  EXPECT_EQ(status("0 0 x 0\n").code(), StatusCode::kParse);
  EXPECT_EQ(status("0 0 nan 0\n").code(), StatusCode::kNonFinite);
  EXPECT_EQ(status("0 0 1000 0\n").code(), StatusCode::kLimit);
  EXPECT_EQ(status("0 0 0 0\n0 0 0 0\n0 0 0 0\n0 0 0 0\n").code(), StatusCode::kLimit);
}

TEST(ParseMhTarget, NamesGitLfsPointers) {
  const Status status =
      ParseMhTarget("version https://git-lfs.github.com/spec/v1\noid sha256:0\n", "a", 3).status();
  EXPECT_EQ(status.code(), StatusCode::kUnsupported);
  EXPECT_NE(status.todo().find("git lfs pull"), std::string::npos);
}

}  // namespace
}  // namespace furrow::authoring
