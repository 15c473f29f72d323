// SPDX-License-Identifier: Apache-2.0
#include "server/shares/token_bucket.h"

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

TEST(TokenBucket, AllowsABurstThenTheRate) {
  TokenBucket bucket(10.0, 3.0);
  const Time start = FromSeconds(100);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(bucket.Take(start));
  EXPECT_FALSE(bucket.Take(start));
  EXPECT_FALSE(bucket.Take(start + FromSeconds(0.09)));
  EXPECT_TRUE(bucket.Take(start + FromSeconds(0.1001)));
  EXPECT_FALSE(bucket.Take(start + FromSeconds(0.1001)));
}

TEST(TokenBucket, NeverHoldsMoreThanTheBurst) {
  TokenBucket bucket(10.0, 2.0);
  EXPECT_TRUE(bucket.Take(FromSeconds(0)));
  int passed = 0;
  while (bucket.Take(FromSeconds(1000))) ++passed;
  EXPECT_EQ(passed, 2);
}

TEST(TokenBucket, TimeThatGoesBackAddsNothing) {
  TokenBucket bucket(10.0, 1.0);
  EXPECT_TRUE(bucket.Take(FromSeconds(10)));
  EXPECT_FALSE(bucket.Take(FromSeconds(5)));
  EXPECT_FALSE(bucket.Take(FromSeconds(10.05)));
  EXPECT_TRUE(bucket.Take(FromSeconds(10.11)));
}

}  // namespace
}  // namespace furrow::server
