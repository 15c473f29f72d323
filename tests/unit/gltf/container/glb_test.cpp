// SPDX-License-Identifier: Apache-2.0
#include "gltf/container/glb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/gltf/gltf_testing.h"

namespace furrow::gltf {
namespace {

using ::testing::ElementsAre;

TEST(SplitContainer, FindsTheChunks) {
  const std::string glb = PackGlb("{}", "1234");
  const Result<Container> parts = SplitContainer(glb);
  ASSERT_TRUE(parts.ok()) << parts.status().ToString();
  EXPECT_EQ(parts->json, "{}  ");
  EXPECT_TRUE(parts->has_binary);
  EXPECT_EQ(parts->binary, "1234");
  EXPECT_TRUE(parts->warnings.empty());
}

TEST(SplitContainer, AcceptsJsonWithBlanksAndByteOrderMark) {
  EXPECT_EQ(SplitContainer("\xEF\xBB\xBF \n{}")->json, "\xEF\xBB\xBF \n{}");
  EXPECT_FALSE(SplitContainer("{}")->has_binary);
}

TEST(SplitContainer, WarnsOfHarmlessDeviations) {
  EXPECT_THAT(SplitContainer(PackGlb("{}", "1234") + "more")->warnings,
              ElementsAre("header.length: ignored 4 bytes after the stated end"));
  EXPECT_THAT(SplitContainer(PackGlb("{}", "12345"))->warnings,
              ElementsAre("chunks[1].length: is not a multiple of 4"));
  std::string glb = PackGlb("{}", "1234") + "cut";
  glb.replace(8, 4, U32(glb.size()));
  EXPECT_THAT(SplitContainer(glb)->warnings,
              ElementsAre("chunks: ignored 3 bytes after the last chunk"));
}

TEST(SplitContainer, NamesTheField) {
  const std::string whole = PackGlb("{}", "1234");
  const auto error = [&](std::size_t at, const std::string& bytes) {
    std::string glb = whole;
    glb.replace(at, bytes.size(), bytes);
    return SplitContainer(glb).status();
  };
  EXPECT_EQ(error(4, U32(1)).where(), "header.version");
  EXPECT_EQ(error(4, U32(1)).code(), StatusCode::kUnsupported);
  EXPECT_EQ(error(8, U32(whole.size() + 1)).where(), "header.length");
  EXPECT_EQ(error(8, U32(19)).where(), "header.length");
  EXPECT_EQ(error(12, U32(0x7FFFFFFF)).where(), "chunks[0].length");
  EXPECT_EQ(error(16, "JSOM").where(), "chunks[0].type");
  EXPECT_EQ(error(24, U32(0xFFFFFFFF)).where(), "chunks[1].length");
  EXPECT_EQ(SplitContainer("").status().where(), "header");
  EXPECT_EQ(SplitContainer("glTF").status().code(), StatusCode::kParse);
  EXPECT_EQ(SplitContainer("hello").status().code(), StatusCode::kParse);
}

}  // namespace
}  // namespace furrow::gltf
