// SPDX-License-Identifier: Apache-2.0
#include "base/status.h"

#include <memory>

#include <gtest/gtest.h>

namespace furrow {
namespace {

TEST(Status, SaysWhereWhatAndWhatToDo) {
  EXPECT_EQ(Status().ToString(), "ok");
  EXPECT_EQ(Status(StatusCode::kParse, "no number").ToString(), "no number");
  EXPECT_EQ(Status(StatusCode::kParse, "no number", "a.bvh:3").ToString(), "a.bvh:3: no number");
  EXPECT_EQ(Status(StatusCode::kParse, "no number", "a.bvh:3", "write one").ToString(),
            "a.bvh:3: no number (write one)");
}

TEST(Status, KeepsTheInnermostPlace) {
  const Status inner(StatusCode::kIo, "cannot read");
  EXPECT_EQ(inner.At("a.json").At("b.json").where(), "a.json");
  EXPECT_EQ(Status().At("a.json").ToString(), "ok");
}

TEST(Result, HoldsAValueOrTheReason) {
  Result<std::unique_ptr<int>> good(std::make_unique<int>(7));
  ASSERT_TRUE(good.ok());
  EXPECT_TRUE(good.status().ok());
  EXPECT_EQ(*std::move(good).value(), 7);
  const Result<int> bad(Status(StatusCode::kLimit, "too long"));
  EXPECT_FALSE(bad.ok());
  EXPECT_EQ(bad.status().code(), StatusCode::kLimit);
}

}  // namespace
}  // namespace furrow
