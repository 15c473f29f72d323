// SPDX-License-Identifier: Apache-2.0
// Hello of a proven address: bundles are sent only to clients that ask for them.
#include <optional>

#include <gtest/gtest.h>

#include "protocol/framing/bundle.h"
#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

class BundlePeer : public FakePeer {
 public:
  void SetTakesBundles(bool takes) override { takes_bundles = takes; }
  std::optional<bool> takes_bundles;  // the last call of SetTakesBundles()
};

class DispatcherHelloTest : public HubTest {
 protected:
  void SetUp() override {
    HubTest::SetUp();
    Connect(&udp, Transport::kUdp);
  }
  BundlePeer udp;
};

TEST_F(DispatcherHelloTest, ItTurnsBundlesOnAndOff) {
  for (const bool bundles : {true, false, true}) {
    Send(udp, protocol::Hello{"test", 1, bundles}, 0, 9);
    const auto welcome = udp.Take<protocol::Welcome>();
    ASSERT_TRUE(welcome.has_value());
    EXPECT_EQ(welcome->message.token, 0u) << "nothing is left to prove";
    EXPECT_EQ(welcome->header.sequence, 9u);
    EXPECT_EQ(udp.takes_bundles, bundles);
  }
}

TEST_F(DispatcherHelloTest, BundlesFromClientsAreMalformed) {
  std::vector<std::vector<std::uint8_t>> pings(2);
  for (auto& ping : pings) encoder.Encode({.session = 77}, protocol::Ping{}, ping);
  std::vector<std::uint8_t> bundle;
  ASSERT_TRUE(protocol::WriteBundle(pings, bundle));
  hub->OnMessage(udp.id, bundle, now);
  EXPECT_EQ(Count(Counter::kMessagesMalformed), 1u);
  EXPECT_TRUE(udp.inbox.empty());
}

TEST_F(DispatcherHelloTest, BundlesAreIgnoredOverTcp) {
  BundlePeer tcp;
  Connect(&tcp, Transport::kTcp);
  Send(tcp, protocol::Hello{"test", 0, true});
  EXPECT_EQ(tcp.Take<protocol::Welcome>()->message.token, 0u);
  EXPECT_FALSE(tcp.takes_bundles.has_value());
}

}  // namespace
}  // namespace furrow::server
