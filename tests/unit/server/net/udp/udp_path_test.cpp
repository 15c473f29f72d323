// SPDX-License-Identifier: Apache-2.0
// From datagram to weight packet through real sockets, the UDP server and the hub.
#include <chrono>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include <asio/io_context.hpp>
#include <gtest/gtest.h>

#include "protocol/messages/hash.h"
#include "server/net/udp/udp_server.h"
#include "tests/unit/allocation_counter.h"
#include "tests/unit/server/net/udp/proven_hello.h"
#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

using asio::ip::udp;

struct Setting {
  int shards = 1;  // they run in turn here
  std::chrono::microseconds busy_poll{0};
};

// Subjects with joints and blend shapes, solved with the filter, each published from a socket of
// its own, and all watched by one UDP subscriber.
class UdpPathTest : public HubTest, public testing::WithParamInterface<Setting> {
 protected:
  static constexpr int kJoints = 12;  // an offer must fit into a datagram
  static constexpr int kSubjects = 8;

  void SetUp() override {
    MakeWith(MakeRig(/*filter=*/true), {}, GetParam().shards);
    OpenPort();
    Connect(viewer);
    viewer.set_option(asio::socket_base::receive_buffer_size(1 << 20));
    for (int i = 0; i < kSubjects; ++i) Connect(senders.emplace_back(io, udp::v4()));
  }
  void TearDown() override {
    for (const auto& server : servers) server->Close();
    io.run();
  }

  // One socket per shard.
  void OpenPort() {
    std::vector<UdpServer*> by_shard;
    for (int shard = 0; shard < GetParam().shards; ++shard) {
      auto& server = servers.emplace_back(
          std::make_unique<UdpServer>(io, Limits(), hub.get(), &metrics, nullptr, shard));
      server->SetBusyPoll(GetParam().busy_poll);
      const std::uint16_t port = shard == 0 ? 0 : servers.front()->port();
      ASSERT_TRUE(
          server->Open({asio::ip::address_v4::loopback(), port}, UdpServer::Port::kShared).ok());
      by_shard.push_back(server.get());
    }
    for (const auto& server : servers) server->Join(by_shard);
    for (const auto& server : servers) server->Start();
  }
  void Connect(udp::socket& socket) {
    socket.connect({asio::ip::address_v4::loopback(), servers.front()->port()});
    socket.non_blocking(true);
  }

  template <class Message, class... Options>
  void Say(udp::socket& socket, const Message& message, protocol::Header header,
           const Options&... options) {
    header.session = 77;
    encoder.Encode(header, message, bytes, options...);
    socket.send(asio::buffer(bytes));
    io.restart();
    io.poll();
  }
  // Reads what the viewer has received and returns the number of weight frames.
  int TakeWeights() {
    int count = 0;
    for (;;) {
      asio::error_code error;
      const std::size_t size = viewer.receive(asio::buffer(received), 0, error);
      if (error) return count;
      protocol::MessageView view;
      EXPECT_EQ(protocol::OpenMessage({received.data(), size}, view), protocol::DecodeStatus::kOk);
      if (view.kind != protocol::MessageKind::kWeights) continue;
      EXPECT_EQ(protocol::Decode(view, weights), protocol::DecodeStatus::kOk);
      ++count;
    }
  }
  static protocol::SkeletonOffer OfferOf(int subject) {
    protocol::SkeletonOffer offer = Offer("subject " + std::to_string(subject));
    for (int i = 0; i < kJoints; ++i) {
      protocol::OfferedJoint joint;
      joint.name = "joint" + std::to_string(i);
      joint.parent = static_cast<std::int16_t>(i - 1);
      offer.joints.push_back(joint);
    }
    offer.skeleton_hash = protocol::SkeletonHash(offer);
    return offer;
  }
  void Meet() {
    viewer.send(asio::buffer(ProvenHello(*hub, viewer)));
    for (udp::socket& sender : senders) sender.send(asio::buffer(ProvenHello(*hub, sender)));
    for (int i = 0; i < kSubjects; ++i) {
      const auto stream = static_cast<std::uint16_t>(i);
      Say(senders[static_cast<std::size_t>(i)], OfferOf(i), {.stream = stream});
      protocol::SubscribeWeights request;
      request.subject = "subject " + std::to_string(i);
      Say(viewer, request, {.sequence = 100u + stream});
    }
    pose = Pose(0.5f, 0.25f);
    pose.skeleton_hash = OfferOf(0).skeleton_hash;
    pose.num_joints = kJoints;
    pose.rotations.resize(kJoints);
  }
  // Sends one pose of every subject and returns the number of weight frames received.
  int Round(std::uint32_t number) {
    for (int i = 0; i < kSubjects; ++i) {
      pose.blend_shapes[0] = static_cast<float>(number % 10) * 0.1f;
      const auto& encoding = number % 2 == 0 ? floats : small;
      Say(senders[static_cast<std::size_t>(i)], pose,
          {.stream = static_cast<std::uint16_t>(i),
           .sequence = number,
           .capture_time_us = 16'667 * static_cast<std::int64_t>(number)},
          encoding);
    }
    return TakeWeights();
  }

  asio::io_context io{1};
  std::vector<std::unique_ptr<UdpServer>> servers;
  udp::socket viewer{io, udp::v4()};
  std::deque<udp::socket> senders;  // by subject
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint8_t> received = std::vector<std::uint8_t>(65536);
  protocol::WeightFrame weights;
  protocol::PoseFrame pose;
  const protocol::PoseEncoding floats;
  const protocol::PoseEncoding small = protocol::PoseEncoding::Small();
};

TEST_P(UdpPathTest, PosesDoNotAllocate) {
  Meet();
  std::uint32_t number = 0;
  while (number < 20) Round(number++);
  const std::uint64_t before = furrow::test::NumAllocations();
  int got = 0;
  for (; number < 70; ++number) got += Round(number);
  EXPECT_EQ(furrow::test::NumAllocations(), before);
  EXPECT_EQ(got, 50 * kSubjects);
  EXPECT_EQ(Count(Counter::kDatagramsUnsendable), 0u);
}

// After one pose has overtaken another, poses wait for earlier ones, and a timer ends the wait.
TEST_P(UdpPathTest, ALostPoseDelaysTheNextOneByATimer) {
  Meet();
  const auto send = [this](std::initializer_list<std::uint32_t> numbers) {
    // One batch, so that all arrive at the same time.
    for (const std::uint32_t number : numbers) {
      encoder.Encode({.session = 77, .sequence = number}, pose, bytes);
      senders[0].send(asio::buffer(bytes));
    }
    io.restart();
    io.poll();
  };
  send({0, 2, 1});
  EXPECT_EQ(TakeWeights(), 2) << "the first time nobody waits";
  send({3, 5, 4});
  EXPECT_EQ(TakeWeights(), 3);
  send({6, 8});
  EXPECT_EQ(Count(Counter::kPosesHeld), 2u);
  // On a busy machine the wait has already ended when send() returns.
  for (int weights_left = 2 - TakeWeights(); weights_left > 0; weights_left -= TakeWeights()) {
    io.restart();
    io.run_one();
  }
  EXPECT_EQ(weights.values.size(), 2u);
}

INSTANTIATE_TEST_SUITE_P(Settings, UdpPathTest,
                         testing::Values(Setting{}, Setting{.shards = 3},
                                         Setting{.busy_poll = std::chrono::microseconds(50)}));

}  // namespace
}  // namespace furrow::server
