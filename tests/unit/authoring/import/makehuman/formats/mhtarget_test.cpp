// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/formats/mhtarget.h"

#include <string>
#include <vector>

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

// A .npy file of these 16-bit values.
std::string Npy(const std::string& type, const std::string& shape, const std::vector<int>& values) {
  const std::string header =
      "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }\n";
  std::string bytes("\x93NUMPY\x01\x00", 8);
  bytes += static_cast<char>(header.size());
  bytes += '\0' + header;
  for (const int value : values) {
    bytes += static_cast<char>(value & 0xff);
    bytes += static_cast<char>(value >> 8 & 0xff);
  }
  return bytes;
}

TEST(ParseMhTargetArrays, AreThousandthsOfADecimetre) {
  const Result<MhTarget> target = ParseMhTargetArrays(
      Npy("<u2", "(2,)", {2, 0}), Npy("<i2", "(2, 3)", {500, -1000, 0, 0, 0, 32767}), "a", 3);
  ASSERT_TRUE(target.ok()) << target.status().ToString();
  EXPECT_EQ(target->vertices, (std::vector<std::uint32_t>{2, 0}));
  EXPECT_EQ(target->offsets[0], 1e-3f * glm::vec3(500.0f, -1000.0f, 0.0f));
  EXPECT_EQ(target->offsets[1], 1e-3f * glm::vec3(0.0f, 0.0f, 32767.0f));
}

TEST(ParseMhTargetArrays, RejectsArraysThatDoNotFit) {
  const std::string one = Npy("<u2", "(1,)", {0});
  const std::string offset = Npy("<i2", "(1, 3)", {1, 2, 3});
  const auto code = [](const std::string& index, const std::string& vector) {
    return ParseMhTargetArrays(index, vector, "a", 3).status().code();
  };
  ASSERT_EQ(code(one, offset), StatusCode::kOk);
  EXPECT_EQ(code(one, one), StatusCode::kSchema);
  EXPECT_EQ(code(offset, offset), StatusCode::kSchema);
  EXPECT_EQ(code(Npy("<i2", "(1,)", {0}), offset), StatusCode::kSchema);
  EXPECT_EQ(code(Npy("<u2", "(2,)", {0, 1}), offset), StatusCode::kSchema);
  EXPECT_EQ(code(one, Npy("<i2", "(3,)", {1, 2, 3})), StatusCode::kSchema);
  EXPECT_EQ(code(Npy("<u2", "(1,)", {3}), offset), StatusCode::kInvalidArgument);
  EXPECT_EQ(code(Npy("<u2", "(4,)", {0, 0, 0, 0}), Npy("<i2", "(4, 3)", std::vector<int>(12, 0))),
            StatusCode::kLimit);
  EXPECT_EQ(code("", offset), StatusCode::kParse);
  EXPECT_EQ(code(one, ""), StatusCode::kParse);
}

}  // namespace
}  // namespace furrow::authoring
