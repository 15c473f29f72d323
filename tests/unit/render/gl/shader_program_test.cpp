// SPDX-License-Identifier: Apache-2.0
#include "render/gl/shader_program.h"

#include <gtest/gtest.h>

#include "render/gl/egl_context.h"

namespace furrow::render {
namespace {

TEST(ShaderProgram, AnErrorHoldsTheDriversLogAndTheFileName) {
  const auto context = EglContext::Create("");
  ASSERT_TRUE(context.ok()) << context.status().ToString();
  constexpr ShaderFile kTwoShaders[] = {{"good.glsl", "void main() { gl_Position = vec4(0.0); }\n"},
                                        {"part.glsl", "float broken() { return undeclared; }\n"},
                                        {"bad.glsl", "#include \"part.glsl\"\nvoid main() {}\n"}};
  const Status status = BuildProgram({"good.glsl", "bad.glsl"}, {}, kTwoShaders).status();
  EXPECT_EQ(status.code(), StatusCode::kInternal);
  EXPECT_EQ(status.where(), "bad.glsl");
  EXPECT_NE(status.what().find("part.glsl"), std::string::npos) << status.what();
  EXPECT_NE(status.what().find("undeclared"), std::string::npos) << status.what();
}

}  // namespace
}  // namespace furrow::render
