// SPDX-License-Identifier: Apache-2.0
#include "server/session/peers/send_credit.h"

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

TEST(SendCredit, AnUnprovenAddressReceivesAtMostWhatItSent) {
  SendCredit credit;
  credit.Received(100);
  EXPECT_TRUE(credit.Spend(60));
  EXPECT_FALSE(credit.Spend(41));
  EXPECT_TRUE(credit.Spend(40));
  EXPECT_FALSE(credit.Spend(1));
  credit.Prove();
  EXPECT_TRUE(credit.Spend(1'000'000));
}

}  // namespace
}  // namespace furrow::server
