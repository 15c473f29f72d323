// SPDX-License-Identifier: Apache-2.0
#include "render/gl/shader_loader.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace furrow::render {
namespace {

constexpr ShaderFile kLibrary[] = {
    {"scene/main.glsl", "first\n#include \"common/a.glsl\"\nthird\n"},
    {"common/a.glsl", "in a\n#include \"b.glsl\"\n"},
    {"b.glsl", "in b\n#include \"common/a.glsl\"\n"},
    {"scene/missing.glsl", "ok\n#include \"nowhere.glsl\"\n"},
    {"unquoted.glsl", "#include <a.glsl>\n"},
};

TEST(ShaderLoader, IncludesEachFileOnceAndKeepsLineNumbers) {
  const std::vector<std::string> defines = {"SIZE 4"};
  const Result<ShaderSource> source = ExpandShader("scene/main.glsl", defines, kLibrary);
  ASSERT_TRUE(source.ok()) << source.status().ToString();
  EXPECT_EQ(source->text,
            "#version 450 core\n"
            "#define SIZE 4\n"
            "#line 1 0\nfirst\n"
            "#line 1 1\nin a\n"
            "#line 1 2\nin b\n"
            "#line 3 2\n"
            "#line 3 1\n"
            "#line 3 0\nthird\n");
  EXPECT_EQ(source->files,
            (std::vector<std::string>{"scene/main.glsl", "common/a.glsl", "b.glsl"}));
}

TEST(ShaderLoader, AMissingFileIsReportedWithTheIncludingLine) {
  const Status status = ExpandShader("scene/missing.glsl", {}, kLibrary).status();
  EXPECT_EQ(status.code(), StatusCode::kNotFound);
  EXPECT_EQ(status.where(), "scene/missing.glsl:2");
  EXPECT_NE(status.what().find("nowhere.glsl"), std::string::npos);
}

TEST(ShaderLoader, AnUnquotedIncludeIsAnError) {
  const Status status = ExpandShader("unquoted.glsl", {}, kLibrary).status();
  EXPECT_EQ(status.code(), StatusCode::kParse);
  EXPECT_EQ(status.where(), "unquoted.glsl:1");
}

TEST(ShaderLoader, LogsNameFilesInTheFormatsOfMesaAndNvidia) {
  const std::vector<std::string> files = {"main.glsl", "a.glsl"};
  EXPECT_EQ(NameSources("1:12(5): error: x\n0(3) : error C1: y\n7:1: z\nplain", files),
            "a.glsl:12(5): error: x\nmain.glsl(3) : error C1: y\n7:1: z\nplain\n");
}

TEST(ShaderLoader, EmbedsEveryShader) {
  std::vector<std::string_view> names;
  for (const ShaderFile& file : EmbeddedShaders()) {
    names.push_back(file.name);
    EXPECT_TRUE(file.text.starts_with("// SPDX-License-Identifier")) << file.name;
    EXPECT_TRUE(ExpandShader(file.name, {}, EmbeddedShaders()).ok()) << file.name;
  }
  for (const char* name :
       {"scene/scene.vert.glsl", "scene/scene.frag.glsl", "post/composite.frag.glsl"}) {
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
  }
}

}  // namespace
}  // namespace furrow::render
