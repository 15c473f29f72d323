// SPDX-License-Identifier: Apache-2.0
#include "gltf/container/json_guard.h"

#include <string>

#include <gtest/gtest.h>

#include "gltf/limits.h"

namespace furrow::gltf {
namespace {

TEST(CheckJsonSize, LimitsTheDepth) {
  const auto nested = [](int depth) {
    const auto size = static_cast<std::size_t>(depth);
    return std::string(size, '[') + std::string(size, ']');
  };
  EXPECT_TRUE(CheckJsonSize(nested(kMaxJsonDepth)).ok());
  EXPECT_EQ(CheckJsonSize(nested(kMaxJsonDepth + 1)).code(), StatusCode::kLimit);
}

TEST(CheckJsonSize, LimitsTheNumberOfValues) {
  EXPECT_TRUE(CheckJsonSize("[" + std::string(kMaxJsonValues - 2, ',') + "]").ok());
  EXPECT_EQ(CheckJsonSize("[" + std::string(kMaxJsonValues, ',') + "]").code(), StatusCode::kLimit);
}

TEST(CheckJsonSize, IgnoresStrings) {
  const std::string brackets(1000, '[');
  EXPECT_TRUE(CheckJsonSize("\"" + brackets + "\\\"" + brackets + "\"").ok());
  EXPECT_EQ(CheckJsonSize("\"\"" + brackets).code(), StatusCode::kLimit);
}

}  // namespace
}  // namespace furrow::gltf
