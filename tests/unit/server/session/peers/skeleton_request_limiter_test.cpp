// SPDX-License-Identifier: Apache-2.0
#include "server/session/peers/skeleton_request_limiter.h"

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

constexpr Time kLimiterStart = FromSeconds(100);

TEST(SkeletonRequestLimiter, AllowsEachStreamOncePerInterval) {
  SkeletonRequestLimiter limiter;
  EXPECT_TRUE(limiter.Allow(1, 1, kLimiterStart));
  EXPECT_FALSE(limiter.Allow(1, 1, kLimiterStart));
  EXPECT_TRUE(limiter.Allow(1, 2, kLimiterStart));
  EXPECT_TRUE(limiter.Allow(2, 1, kLimiterStart));
  EXPECT_TRUE(limiter.Allow(1, 1, kLimiterStart + SkeletonRequestLimiter::kInterval));
}

TEST(SkeletonRequestLimiter, FurtherStreamsWaitForTheNextInterval) {
  SkeletonRequestLimiter limiter;
  for (std::uint64_t session = 1; session <= SkeletonRequestLimiter::kMaxStreams; ++session) {
    EXPECT_TRUE(limiter.Allow(session, 1, kLimiterStart));
  }
  EXPECT_FALSE(limiter.Allow(9999, 1, kLimiterStart));
  EXPECT_TRUE(limiter.Allow(9999, 1, kLimiterStart + SkeletonRequestLimiter::kInterval));
}

}  // namespace
}  // namespace furrow::server
