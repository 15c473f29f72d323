// SPDX-License-Identifier: Apache-2.0
// Hello: bundles are sent only to proven addresses that ask for them.
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
  // The token in the reply.
  std::uint64_t Hello(std::uint64_t token, bool bundles) {
    Send(udp, protocol::Hello{"test", token, bundles});
    const auto welcome = udp.Take<protocol::Welcome>();
    return welcome ? welcome->message.token : 0;
  }
  BundlePeer udp;
};

TEST_F(DispatcherHelloTest, AProvenAddressMayTurnBundlesOn) {
  const std::uint64_t token = Hello(0, true);
  EXPECT_FALSE(udp.takes_bundles.has_value()) << "anybody can say so from a forged address";
  EXPECT_EQ(Hello(token, true), 0u);
  EXPECT_EQ(udp.takes_bundles, true);
}

TEST_F(DispatcherHelloTest, ClientsThatDoNotOptInNeverReceiveBundles) {
  const std::uint64_t token = Hello(0, false);
  Hello(token, false);
  EXPECT_EQ(udp.takes_bundles, false);
}

TEST_F(DispatcherHelloTest, AForgedHelloCanOnlyTurnBundlesOff) {
  const std::uint64_t token = Hello(0, false);
  Hello(token, false);
  Hello(0, true);
  Hello(token + 1, true);
  EXPECT_EQ(udp.takes_bundles, false);
  Hello(token, true);
  EXPECT_EQ(udp.takes_bundles, true);
  Hello(0, false);  // perhaps another client at this address, without bundles
  EXPECT_EQ(udp.takes_bundles, false);
}

TEST_F(DispatcherHelloTest, BundlesFromClientsAreMalformed) {
  std::vector<std::vector<std::uint8_t>> pings(2);
  for (auto& ping : pings) encoder.Encode({.session = 77}, protocol::Ping{}, ping);
  std::vector<std::uint8_t> bundle;
  ASSERT_TRUE(protocol::WriteBundle(pings, bundle));
  hub->OnBytesReceived(udp.id, bundle.size(), now);
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
