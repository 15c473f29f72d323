// SPDX-License-Identifier: Apache-2.0
// One port with several sockets and one thread each.
#include "server/net/udp/udp_port.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/server/net/udp/proven_hello.h"
#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

using asio::ip::udp;

constexpr int kShards = 3;
constexpr int kSenders = 48;  // the chance that all map to one shard is below 1e-22

class UdpPortTest : public HubTest {
 protected:
  void SetUp() override {
    Hub::Parts parts;
    parts.session = 4242;
    parts.rig = std::make_shared<const wrinkle::Rig>(MakeRig(/*filter=*/false));
    parts.metrics = &metrics;
    parts.random = [] { return 900u; };
    parts.shards = kShards;
    hub = std::make_unique<Hub>(std::move(parts));
    hub->SetOnWeights([this](const Subject& subject, int shard, Time) {
      const std::lock_guard lock(mutex_);
      shards_of_[subject.name].insert(shard);
      ++num_poses_;
    });
    port_ = std::make_unique<UdpPort>(io_, kShards, Limits(), hub.get(), &metrics, nullptr);
    const Status status = port_->Open({asio::ip::address_v4::loopback(), 0});
    ASSERT_TRUE(status.ok()) << status.ToString();
    port_->Start();
    thread_ = std::jthread([this] { io_.run(); });
  }
  void TearDown() override {
    io_.stop();
    thread_.join();
    port_->Close();
  }

  asio::io_context io_{1};
  std::unique_ptr<UdpPort> port_;
  std::jthread thread_;
  std::mutex mutex_;
  std::map<std::string, std::set<int>> shards_of_;
  std::atomic<int> num_poses_ = 0;
};

TEST_F(UdpPortTest, SendersAreSpreadOverShardsAndStayThere) {
  constexpr int kPoses = 5;
  asio::io_context io;
  std::deque<udp::socket> senders;
  std::vector<std::uint8_t> bytes(2000);
  const auto send = [&](udp::socket& socket, const auto& message, std::uint32_t sequence) {
    encoder.Encode({77, 1, sequence, 1 + sequence}, message, bytes);
    socket.send(asio::buffer(bytes));
  };
  for (int i = 0; i < kSenders; ++i) {
    udp::socket& socket = senders.emplace_back(io, udp::v4());
    socket.connect({asio::ip::address_v4::loopback(), port_->port()});
    socket.send(asio::buffer(ProvenHello(*hub, socket)));
    bytes.resize(2000);
    socket.receive(asio::buffer(bytes));  // welcome
    send(socket, Offer("subject " + std::to_string(i)), 0);
    bytes.resize(2000);
    socket.receive(asio::buffer(bytes));  // accepted
  }
  for (std::uint32_t pose = 0; pose < kPoses; ++pose) {
    for (udp::socket& socket : senders) send(socket, Pose(0.5f), pose);
  }
  while (num_poses_ < kSenders * kPoses) std::this_thread::yield();
  const std::lock_guard lock(mutex_);
  ASSERT_EQ(shards_of_.size(), std::size_t{kSenders});
  std::set<int> used;
  for (const auto& [subject, shards] : shards_of_) {
    EXPECT_EQ(shards.size(), 1u) << subject;
    used.insert(shards.begin(), shards.end());
  }
  EXPECT_GT(used.size(), 1u);
  EXPECT_EQ(Count(Counter::kPosesReceived), std::uint64_t{kSenders * kPoses});
}

Hub::Parts TwoShards(Metrics* metrics) {
  Hub::Parts parts;
  parts.session = 1;
  parts.rig = std::make_shared<const wrinkle::Rig>();
  parts.metrics = metrics;
  parts.random = [] { return 1u; };
  parts.shards = 2;
  return parts;
}

class BrokenTap : public RecordingTap {
 public:
  void OnOffer(const Subject&, const protocol::SkeletonOffer&, Time) override {}
  void OnPose(const Subject&, std::span<const std::uint8_t>, Time) override {}
  void OnWeights(const Subject&, std::int64_t, Time) override {}
  void OnSubjectGone(const Subject&) override {}
  void OnRig(const wrinkle::Rig&, const SubjectRegistry&, Time) override {}
  void OnDatagram(const std::array<std::uint8_t, 18>&, std::span<const std::uint8_t>,
                  Time) override {
    if (out_of_memory) throw std::bad_alloc();
    throw std::runtime_error("broken");
  }
  bool out_of_memory = false;
};

TEST(UdpPortFailure, LackOfMemoryCostsOneDatagram) {
  Metrics metrics;
  Hub hub(TwoShards(&metrics));
  asio::io_context io{1};
  BrokenTap broken;
  broken.out_of_memory = true;
  UdpServer server(io, Limits(), &hub, &metrics, &broken);
  ASSERT_TRUE(server.Open({asio::ip::address_v4::loopback(), 0}).ok());
  server.Start();
  udp::socket sender(io, udp::v4());
  const std::vector<std::uint8_t> hello = ProvenHello(hub, sender);
  for (std::uint64_t i = 1; i <= 3; ++i) {
    sender.send_to(asio::buffer(hello), {asio::ip::address_v4::loopback(), server.port()});
    while (metrics.Get(Counter::kAllocationsFailed) < i) io.run_one_for(std::chrono::seconds(1));
  }
  server.Close();
}

TEST(UdpPortFailure, AnExceptionInAShardEndsTheCallersLoop) {
  Metrics metrics;
  Hub::Parts parts = TwoShards(&metrics);
  Hub hub(std::move(parts));
  asio::io_context io{1};
  BrokenTap broken;
  UdpPort port(io, 2, Limits(), &hub, &metrics, &broken);
  ASSERT_TRUE(port.Open({asio::ip::address_v4::loopback(), 0}).ok());
  port.Start();
  udp::socket sender(io, udp::v4());
  sender.send_to(asio::buffer(ProvenHello(hub, sender)),
                 {asio::ip::address_v4::loopback(), port.port()});
  EXPECT_THROW(io.run_for(std::chrono::seconds(20)), std::runtime_error);
}

TEST(UdpPortFailure, DatagramsFromBeforeAllSocketsWereOpenAreDropped) {
  Metrics metrics;
  Hub hub(TwoShards(&metrics));
  asio::io_context io{1};
  UdpServer server(io, Limits(), &hub, &metrics);
  ASSERT_TRUE(server.Open({asio::ip::address_v4::loopback(), 0}).ok());
  udp::socket sender(io, udp::v4());
  sender.connect({asio::ip::address_v4::loopback(), server.port()});
  std::vector<std::uint8_t> hello;
  const auto send = [&](std::uint32_t sequence) {
    protocol::Encoder().Encode({77, 0, sequence, 0}, protocol::Hello{"test"}, hello);
    sender.send(asio::buffer(hello));
  };
  send(1);
  server.DropWaiting();
  send(2);
  server.Start();
  while (metrics.Get(Counter::kDatagramsSent) == 0) io.run_one_for(std::chrono::seconds(1));
  EXPECT_EQ(metrics.Get(Counter::kDatagramsReceived), 1u);
  server.Close();
}

TEST_F(UdpPortTest, APortInUseIsAnError) {
  Hub other(TwoShards(&metrics));
  asio::io_context io;
  UdpPort second(io, 2, Limits(), &other, &metrics, nullptr);
  const Status status = second.Open({asio::ip::address_v4::loopback(), port_->port()});
  EXPECT_EQ(status.code(), StatusCode::kUnavailable);
}

}  // namespace
}  // namespace furrow::server
