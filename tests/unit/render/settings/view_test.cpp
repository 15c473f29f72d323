// SPDX-License-Identifier: Apache-2.0
#include "render/settings/view.h"

#include <gtest/gtest.h>

namespace furrow::render {
namespace {

TEST(ParseView, ParsesNamesAndListsThemInErrors) {
  EXPECT_EQ(*ParseView("mask_dynamic"), View::kMaskDynamic);
  EXPECT_EQ(ViewName(View::kWireframe), "wireframe");
  const Status status = ParseView("x-ray").status();
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_NE(status.ToString().find("mask_texture"), std::string::npos);
}

}  // namespace
}  // namespace furrow::render
