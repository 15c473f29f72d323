// SPDX-License-Identifier: Apache-2.0
#include "server/net/door/end_notice.h"

#include <memory>

#include <gtest/gtest.h>

#include "tests/unit/allocation_counter.h"

namespace furrow::server {
namespace {

TEST(EndNotice, CallsOnceAtItsEnd) {
  int calls = 0;
  const std::shared_ptr<void> owner = std::make_shared<char>();
  const test::AllocationLimit limit(0);
  {
    const EndNotice notice(owner, [&calls] { ++calls; });
    EXPECT_EQ(calls, 0);
  }
  EXPECT_EQ(calls, 1);
}

TEST(EndNotice, CallsNothingAfterCancel) {
  int calls = 0;
  const std::shared_ptr<void> owner = std::make_shared<char>();
  {
    EndNotice notice(owner, [&calls] { ++calls; });
    notice.Cancel();
  }
  EXPECT_EQ(calls, 0);
}

TEST(EndNotice, CallsNothingAfterItsOwner) {
  int calls = 0;
  std::shared_ptr<void> owner = std::make_shared<char>();
  {
    const EndNotice notice(owner, [&calls] { ++calls; });
    owner.reset();
  }
  EXPECT_EQ(calls, 0);
}

}  // namespace
}  // namespace furrow::server
