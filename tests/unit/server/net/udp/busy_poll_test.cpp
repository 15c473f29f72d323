// SPDX-License-Identifier: Apache-2.0
// A thread that looks for datagrams instead of sleeping.
#include <chrono>
#include <cstdint>
#include <memory>

#include <asio/io_context.hpp>
#include <asio/post.hpp>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include "server/net/udp/udp_server.h"
#include "tests/unit/server/net/udp/proven_hello.h"
#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

using asio::ip::udp;

class BusyPollTest : public HubTest {
 protected:
  void Open(Time busy_poll) {
    server_ = std::make_unique<UdpServer>(io_, Limits(), hub.get(), &metrics);
    server_->SetBusyPoll(busy_poll);
    ASSERT_TRUE(server_->Open({asio::ip::address_v4::loopback(), 0}).ok());
    server_->Start();
    client_.connect({asio::ip::address_v4::loopback(), server_->port()});
  }
  void TearDown() override {
    server_->Close();
    io_.run();
  }
  // Sends a datagram and runs the loop until the server has received it.
  void Send() {
    const std::uint64_t before = Count(Counter::kDatagramsReceived);
    client_.send(asio::buffer(ProvenHello(*hub, client_)));
    while (Count(Counter::kDatagramsReceived) == before) io_.run_one();
  }

  asio::io_context io_{1};
  std::unique_ptr<UdpServer> server_;
  udp::socket client_{io_, udp::v4()};
};

TEST_F(BusyPollTest, WithoutItEveryDatagramWakesTheThread) {
  Open(Time{0});
  for (int i = 0; i < 5; ++i) Send();
  EXPECT_EQ(Count(Counter::kWakeUps), 5u);
  EXPECT_EQ(Count(Counter::kWakeUpsSpared), 0u);
}

TEST_F(BusyPollTest, OnlyTheFirstDatagramWakesTheThread) {
  Open(std::chrono::hours(1));
  for (int i = 0; i < 5; ++i) Send();
  EXPECT_EQ(Count(Counter::kWakeUps), 1u);
  EXPECT_EQ(Count(Counter::kWakeUpsSpared), 4u);
}

TEST_F(BusyPollTest, TheThreadSleepsAfterTheTime) {
  Open(std::chrono::microseconds(1));
  Send();
  io_.poll();  // would never return while the thread looks for datagrams
  Send();
  EXPECT_EQ(Count(Counter::kWakeUps), 2u);
}

TEST_F(BusyPollTest, StrangersDoNotKeepTheThreadBusy) {
  Open(std::chrono::hours(1));
  for (std::uint64_t sent = 1; sent <= 3; ++sent) {
    client_.send(asio::buffer("no message"));
    while (Count(Counter::kDatagramsReceived) < sent) io_.run_one();
    io_.poll();  // would never return while the thread looks for datagrams
  }
  EXPECT_EQ(Count(Counter::kWakeUps), 3u);
  EXPECT_EQ(Count(Counter::kWakeUpsSpared), 0u);
}

TEST_F(BusyPollTest, AnAdoptedSocketLosesTheOptionOfTheFormerDaemon) {
  udp::socket former(io_, {asio::ip::address_v4::loopback(), 0});
  const int time_us = 50;
  const bool may_set =
      setsockopt(former.native_handle(), SOL_SOCKET, SO_BUSY_POLL, &time_us, sizeof(time_us)) == 0;
  server_ = std::make_unique<UdpServer>(io_, Limits(), hub.get(), &metrics);
  ASSERT_TRUE(server_->Adopt(former.release()).ok());
  if (!may_set) GTEST_SKIP() << "needs the capability CAP_NET_ADMIN";
  int left_us = -1;
  socklen_t size = sizeof(left_us);
  ASSERT_EQ(getsockopt(server_->socket(), SOL_SOCKET, SO_BUSY_POLL, &left_us, &size), 0);
  EXPECT_EQ(left_us, 0);
}

TEST_F(BusyPollTest, OtherWorkHasItsTurn) {
  Open(std::chrono::hours(1));
  Send();
  bool has_run = false;
  asio::post(io_, [&] { has_run = true; });
  for (int turn = 0; turn < 3 && !has_run; ++turn) io_.run_one();
  EXPECT_TRUE(has_run);
}

TEST_F(BusyPollTest, ARestartEndsTheSearch) {
  Open(std::chrono::hours(1));
  Send();
  server_->StopReading();
  io_.poll();
  client_.send(asio::buffer(ProvenHello(*hub, client_)));
  io_.restart();
  io_.poll();
  EXPECT_EQ(Count(Counter::kDatagramsReceived), 1u) << "the next daemon reads it";
}

}  // namespace
}  // namespace furrow::server
