// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/formats/obj.h"

#include <memory>
#include <string>

#include <gtest/gtest.h>

namespace furrow::authoring {
namespace {

constexpr char kTwoFaces[] =
    "# two faces\r\n"
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "f 1/1 2/2 3/3\n"
    "g body extra\n"
    "vn 0 0 1\n"
    "f -4/-4/1 -3/-3/1 -2/-2/1 -1/-1/1 # by counting back\n"
    "g helper\n"
    "f 1 2 3\n"
    "g body\n"
    "f 1//1 3//1 4//1\n";

TEST(ImportObj, ReadsFacesByGroup) {
  const Result<ObjMesh> mesh = ParseObj(kTwoFaces, "two.obj");
  ASSERT_TRUE(mesh.ok()) << mesh.status().ToString();
  EXPECT_EQ(mesh->positions.size(), 4u);
  EXPECT_EQ(mesh->uvs.size(), 4u);
  ASSERT_EQ(mesh->faces.size(), 4u);
  EXPECT_EQ(mesh->groups, (std::vector<std::string>{"", "body", "helper"}));
  EXPECT_EQ(mesh->FindGroup("helper"), 2);
  EXPECT_EQ(mesh->FindGroup("tail"), -1);
  EXPECT_EQ(mesh->faces[0].group, 0);
  EXPECT_EQ(mesh->faces[1].num_corners, 4);
  EXPECT_EQ(mesh->faces[3].group, 1);  // a group may continue later
  const ObjMesh::Corner& last = mesh->corners[mesh->faces[1].first_corner + 3u];
  EXPECT_EQ(last.position, 3u);
  EXPECT_EQ(last.uv, 3);
  EXPECT_EQ(mesh->corners[mesh->faces[2].first_corner].uv, -1);
  EXPECT_EQ(mesh->corners[mesh->faces[3].first_corner].uv, -1);
}

struct BadObj {
  const char* text;
  StatusCode code;
  const char* where;
};

class ImportObjErrors : public testing::TestWithParam<BadObj> {};

TEST_P(ImportObjErrors, NameTheLine) {
  const Result<ObjMesh> mesh = ParseObj(GetParam().text, "bad.obj");
  ASSERT_FALSE(mesh.ok());
  EXPECT_EQ(mesh.status().code(), GetParam().code) << mesh.status().ToString();
  EXPECT_EQ(mesh.status().where(), GetParam().where);
}

INSTANTIATE_TEST_SUITE_P(
    Each, ImportObjErrors,
    testing::Values(BadObj{"", StatusCode::kParse, "bad.obj"},
                    BadObj{"v 0 0\n", StatusCode::kParse, "bad.obj:1"},
                    BadObj{"v 0 0 zero\n", StatusCode::kParse, "bad.obj:1"},
                    BadObj{"v 0 0 1e\n", StatusCode::kParse, "bad.obj:1"},
                    BadObj{"\nv 0 nan 0\n", StatusCode::kNonFinite, "bad.obj:2"},
                    BadObj{"v 0 0 0\nvt inf 0\n", StatusCode::kNonFinite, "bad.obj:2"},
                    BadObj{"v 0 0 0\nf 1 1\n", StatusCode::kParse, "bad.obj:2"},
                    BadObj{"v 0 0 0\nf 1 1 2\n", StatusCode::kInvalidArgument, "bad.obj:2"},
                    BadObj{"v 0 0 0\nf 1 1 0\n", StatusCode::kInvalidArgument, "bad.obj:2"},
                    BadObj{"v 0 0 0\nf 1 1 -2\n", StatusCode::kInvalidArgument, "bad.obj:2"},
                    BadObj{"v 0 0 0\nf 1/1 1 1\n", StatusCode::kInvalidArgument, "bad.obj:2"},
                    BadObj{"v 0 0 0\nf 1 1 99999999999999999999\n", StatusCode::kParse,
                           "bad.obj:2"},
                    BadObj{"v 0 0 0\nf 1 1 x\n", StatusCode::kParse, "bad.obj:2"}));

TEST(ImportObj, RejectsFacesWithManyCorners) {
  std::string text = "v 0 0 0\nf";
  for (int i = 0; i < 65; ++i) text += " 1";
  EXPECT_EQ(ParseObj(text, "x").status().code(), StatusCode::kParse);
}

// Reads every prefix of a valid file from a buffer of exactly its size, so that sanitizers detect
// reads past the end.
TEST(ImportObj, TruncatedInputIsReadOrRejected) {
  const std::string text = kTwoFaces;
  int good = 0;
  for (std::size_t length = 0; length <= text.size(); ++length) {
    const std::unique_ptr<char[]> copy(new char[length]);
    text.copy(copy.get(), length);
    const Result<ObjMesh> mesh = ParseObj({copy.get(), length}, "cut.obj");
    if (!mesh.ok()) continue;
    ++good;
    for (const ObjMesh::Corner& corner : mesh->corners) {
      EXPECT_LT(corner.position, mesh->positions.size());
      EXPECT_LT(corner.uv, static_cast<int>(mesh->uvs.size()));
    }
  }
  EXPECT_GT(good, 0);
  EXPECT_LT(good, static_cast<int>(text.size()));
}

}  // namespace
}  // namespace furrow::authoring
