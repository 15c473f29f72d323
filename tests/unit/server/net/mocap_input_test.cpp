// SPDX-License-Identifier: Apache-2.0
#include "server/net/mocap_input.h"

#include <chrono>
#include <memory>
#include <new>
#include <span>
#include <utility>

#include <asio/buffer.hpp>
#include <asio/ip/udp.hpp>
#include <gtest/gtest.h>

#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

using asio::ip::udp;

class GreedyAdapter : public protocol::mocap::MocapAdapter {
 public:
  void Push(std::span<const std::uint8_t>, std::int64_t,
            const protocol::mocap::FrameSink&) override {
    throw std::bad_alloc();
  }
  void Tick(std::int64_t, const protocol::mocap::FrameSink&) override {}
};

using MocapInputTest = HubTest;

TEST_F(MocapInputTest, LackOfMemoryCostsOneDatagram) {
  asio::io_context io{1};
  MocapInput input(io, "--vmc", std::make_unique<GreedyAdapter>(),
                   SenderGate({}, SenderGate::Policy::kOne), hub.get(), &metrics);
  ASSERT_TRUE(input.Open({asio::ip::address_v4::loopback(), 0}).ok());
  input.Start();
  udp::socket sender(io, udp::v4());
  for (std::uint64_t i = 1; i <= 3; ++i) {
    sender.send_to(asio::buffer("pose"), {asio::ip::address_v4::loopback(), input.port()});
    while (metrics.Get(Counter::kAllocationsFailed) < i) io.run_one_for(std::chrono::seconds(1));
  }
  EXPECT_EQ(metrics.Get(Counter::kMocapPackets), 3u);
  input.Close();
}

}  // namespace
}  // namespace furrow::server
