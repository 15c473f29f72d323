// SPDX-License-Identifier: Apache-2.0
#include "server/core/network_address.h"

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

TEST(NetworkAddress, OnlyNumericAddressesWithoutBracketsAreNumeric) {
  EXPECT_TRUE(IsNumericAddress("127.0.0.1"));
  EXPECT_TRUE(IsNumericAddress("::1"));
  for (const char* other : {"", "localhost", "[::1]", "127.0.0.1:80", "256.0.0.1"}) {
    EXPECT_FALSE(IsNumericAddress(other)) << other;
  }
}

TEST(NetworkAddress, AHostIsAnAddressOrAnIpv6Network) {
  EXPECT_EQ(HostOf("192.168.0.20"), "192.168.0.20");
  EXPECT_EQ(HostOf("::ffff:192.168.0.20"), "192.168.0.20");
  EXPECT_EQ(HostOf("2001:db8:1:2:3:4:5:6"), "2001:db8:1:2::");
  EXPECT_EQ(HostOf("2001:db8:1:2::9"), HostOf("2001:db8:1:2:3:4:5:6"));
  EXPECT_NE(HostOf("2001:db8:1:3::9"), HostOf("2001:db8:1:2::9"));
  EXPECT_EQ(HostOf("fe80::1:2:3:4%eth0"), "fe80::");
  EXPECT_EQ(HostOf("::1"), "::");
  EXPECT_EQ(HostOf("somewhere"), "somewhere");
}

TEST(NetworkAddress, TextReadsBack) {
  for (const char* text : {"127.0.0.1:9000", "[::1]:1"}) {
    const Result<HostPort> parsed = ParseHostPort(text);
    ASSERT_TRUE(parsed.ok()) << text;
    EXPECT_EQ(HostPortText(*parsed), text);
  }
}

TEST(NetworkAddress, KnowsTheAddressesOfThisComputer) {
  for (const char* local : {"127.0.0.1", "127.8.9.10", "::1", "::ffff:127.0.0.1"}) {
    EXPECT_TRUE(IsLoopback(local)) << local;
  }
  for (const char* other :
       {"128.0.0.1", "10.0.0.1", "::", "::2", "::ffff:10.0.0.1", "", "localhost"}) {
    EXPECT_FALSE(IsLoopback(other)) << other;
  }
}

}  // namespace
}  // namespace furrow::server
