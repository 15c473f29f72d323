// SPDX-License-Identifier: Apache-2.0
#include "client/net/poller.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

namespace furrow::net {
namespace {

class PollerTest : public testing::TestWithParam<Poller::Calls> {
 protected:
  void SetUp() override {
    int ends[2];
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_DGRAM, 0, ends), 0);
    here_ = Descriptor(ends[0]);
    there_ = Descriptor(ends[1]);
    poller_.Add(here_.get(), 42);
  }

  Poller poller_{GetParam()};
  Descriptor here_;
  Descriptor there_;
};

TEST_P(PollerTest, ALevelTriggeredDescriptorIsReportedUntilItIsRead) {
  EXPECT_TRUE(poller_.Wait(0).empty());
  EXPECT_TRUE(poller_.Wait(-5).empty());
  EXPECT_TRUE(poller_.Wait(1000).empty());
  ASSERT_EQ(send(there_.get(), "x", 1, 0), 1);
  for (int i = 0; i < 2; ++i) {
    const auto events = poller_.Wait(60'000'000'000);
    ASSERT_EQ(events.size(), 1u);
    EXPECT_EQ(events[0].data.u64, 42u);
  }
  char byte = 0;
  ASSERT_EQ(recv(here_.get(), &byte, 1, 0), 1);
  EXPECT_TRUE(poller_.Wait(0).empty());
}

TEST_P(PollerTest, AnEdgeTriggeredDescriptorIsReportedOnce) {
  poller_.Remove(here_.get());
  poller_.Add(here_.get(), 43, Poller::When::kEdge);
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(send(there_.get(), "x", 1, 0), 1);
    const auto events = poller_.Wait(60'000'000'000);
    ASSERT_EQ(events.size(), 1u);
    EXPECT_EQ(events[0].data.u64, 43u);
    EXPECT_TRUE(poller_.Wait(0).empty());
  }
}

TEST_P(PollerTest, ARemovedDescriptorIsNotReported) {
  ASSERT_EQ(send(there_.get(), "x", 1, 0), 1);
  poller_.Remove(here_.get());
  EXPECT_TRUE(poller_.Wait(0).empty());
}

INSTANTIATE_TEST_SUITE_P(Calls, PollerTest,
                         testing::Values(Poller::Calls::kOne, Poller::Calls::kTwo));

}  // namespace
}  // namespace furrow::net
