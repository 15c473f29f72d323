// SPDX-License-Identifier: Apache-2.0
#include "render/gl/egl_context.h"

#include <gtest/gtest.h>

namespace furrow::render {
namespace {

TEST(EglContext, AnUnknownDeviceIsRejectedByName) {
  const Status status = EglContext::Create("gpu9").status();
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_NE(status.what().find("gpu9"), std::string::npos);
  EXPECT_EQ(EglContext::Create("9999").status().code(), StatusCode::kInvalidArgument);
}

TEST(EglContext, SurvivesTheDestructionOfAnotherContext) {
  auto first = EglContext::Create("");
  auto second = EglContext::Create("");
  ASSERT_TRUE(first.ok() && second.ok());
  EXPECT_TRUE((*first)->MakeCurrent().ok());
  (*second).reset();
  EXPECT_TRUE((*first)->MakeCurrent().ok());
  EXPECT_NE((*first)->description().find("device"), std::string::npos);
}

// Whatever EGL says of a device: the renderer decides what a fragment costs.
TEST(EglContext, KnowsSoftwareByItsRenderer) {
  for (const char* device : {"", "surfaceless"}) {
    auto context = EglContext::Create(device);
    if (!context.ok()) continue;  // no Mesa
    const bool is_llvmpipe = (*context)->description().find("llvmpipe") != std::string::npos;
    EXPECT_EQ((*context)->is_software(), is_llvmpipe) << (*context)->description();
  }
}

}  // namespace
}  // namespace furrow::render
