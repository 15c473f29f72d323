// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/formats/mhmat.h"

#include <string>

#include <gtest/gtest.h>

namespace furrow::authoring {
namespace {

TEST(ParseMhmat, ReadsWhatIsDrawn) {
  const Result<MhMaterial> material = ParseMhmat(
      "# comment\n// another\nname short02\ndiffuseColor 1.0 0.5 2\ntransparent True\n"
      "backfaceCull False\ndiffuseTexture textures\\my hair.png\nnormalmapTexture n.png\n"
      "shader data/shaders/glsl/litsphere\nshaderConfig diffuse True\n",
      "a.mhmat");
  ASSERT_TRUE(material.ok()) << material.status().ToString();
  EXPECT_EQ(material->name, "short02");
  EXPECT_EQ(material->colour, glm::vec3(1.0f, 0.5f, 1.0f));
  EXPECT_EQ(material->colour_picture, "textures/my hair.png");
  EXPECT_EQ(material->normal_picture, "n.png");
  EXPECT_TRUE(material->transparent);
  EXPECT_TRUE(material->double_sided);
}

TEST(ParseMhmat, RejectsWithTheLine) {
  const auto status = [](const std::string& text) { return ParseMhmat(text, "a").status(); };
  EXPECT_EQ(status("name a\ndiffuseColor 1 1\n").code(), StatusCode::kParse);
  EXPECT_EQ(status("name a\ndiffuseColor 1 1\n").where(), "a:2");
  EXPECT_EQ(status("diffuseColor 1 x 1\n").code(), StatusCode::kParse);
  EXPECT_EQ(status("diffuseColor 1 inf 1\n").code(), StatusCode::kNonFinite);
  EXPECT_EQ(status("diffuseTexture " + std::string(2000, 'x') + "\n").code(), StatusCode::kLimit);
  EXPECT_EQ(status("\x01garbage\xff\n").code(), StatusCode::kSchema);
  EXPECT_EQ(status("version https://git-lfs.github.com/spec/v1\n").code(),
            StatusCode::kUnsupported);
}

}  // namespace
}  // namespace furrow::authoring
