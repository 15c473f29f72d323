// SPDX-License-Identifier: Apache-2.0
#include "server/net/udp/udp_address.h"

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

using asio::ip::udp;

udp::endpoint ThereAndBack(const char* address) {
  const udp::endpoint endpoint(asio::ip::make_address(address), 7401);
  return ToEndpoint(ToPeerAddress(endpoint), endpoint.address().is_v4(), ScopeOf(endpoint));
}

// Without the interface, the system refuses to send to a link-local address.
TEST(UdpAddress, SurvivesTheFormOfSealedDatagrams) {
  for (const char* address : {"192.0.2.1", "2001:db8::1", "::ffff:192.0.2.1", "fe80::1%1"}) {
    EXPECT_EQ(ThereAndBack(address), udp::endpoint(asio::ip::make_address(address), 7401))
        << address;
  }
}

}  // namespace
}  // namespace furrow::server
