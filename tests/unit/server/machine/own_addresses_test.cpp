// SPDX-License-Identifier: Apache-2.0
#include "server/machine/own_addresses.h"

#include <gtest/gtest.h>

#include "server/core/network_address.h"

namespace furrow::server {
namespace {

TEST(OwnAddresses, OnlyThisComputerReachesLoopback) {
  EXPECT_TRUE(ReachableAddresses("127.0.0.1").empty());
  EXPECT_TRUE(ReachableAddresses("::1").empty());
}

TEST(OwnAddresses, AnAddressReachesItself) {
  EXPECT_EQ(ReachableAddresses("192.0.2.7"), (std::vector<std::string>{"192.0.2.7"}));
}

TEST(OwnAddresses, AnyAddressMeansThoseOfTheInterfaces) {
  for (const std::string& address : ReachableAddresses("0.0.0.0")) {
    EXPECT_TRUE(IsNumericAddress(address)) << address;
    EXPECT_FALSE(IsLoopback(address)) << address;
    EXPECT_EQ(address.find(':'), std::string::npos) << address << " does not reach 0.0.0.0";
  }
}

TEST(OwnAddresses, OtherComputersHaveOtherAddresses) {
  for (const char* own : {"127.0.0.1", "::1", "::ffff:127.0.0.1"}) EXPECT_TRUE(IsOwnAddress(own));
  for (const std::string& own : ReachableAddresses("0.0.0.0")) {
    EXPECT_TRUE(IsOwnAddress(own));
    EXPECT_TRUE(IsOwnAddress("::ffff:" + own));
  }
  for (const char* other : {"192.0.2.1", "::ffff:192.0.2.1", "2001:db8::1", "", "ada"}) {
    EXPECT_FALSE(IsOwnAddress(other)) << other;
  }
}

}  // namespace
}  // namespace furrow::server
