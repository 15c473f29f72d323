// SPDX-License-Identifier: Apache-2.0
// UdpSender packs messages into bundles.
#include <algorithm>
#include <map>
#include <random>
#include <vector>

#include <asio/io_context.hpp>
#include <gtest/gtest.h>

#include "protocol/codec/codec.h"
#include "protocol/framing/bundle.h"
#include "server/net/udp/udp_sender.h"

namespace furrow::server {
namespace {

using asio::ip::udp;
using Bytes = std::vector<std::uint8_t>;

class UdpBundlesTest : public testing::Test {
 protected:
  void SetUp() override {
    socket.non_blocking(true);
    sender.Open(socket.native_handle());
    for (udp::socket* end : {&a, &b}) {
      end->set_option(asio::socket_base::receive_buffer_size(1 << 20));
      end->non_blocking(true);
    }
  }
  // A whole message of the given size, with a number.
  Bytes Message(std::size_t bytes) {
    Bytes payload(bytes - protocol::kEnvelopeBytes);
    for (std::uint8_t& byte : payload) byte = static_cast<std::uint8_t>(random());
    Bytes message;
    protocol::WriteMessage({.session = 7, .sequence = next_sequence++}, payload, message);
    return message;
  }
  void Push(udp::socket& to, const Bytes& message, Packing packing) {
    std::ranges::copy(message, sender.Prepare().begin());
    sender.Commit(to.native_handle(), to.local_endpoint(), message.size(), packing);
  }
  // The messages in each received datagram.
  static std::vector<std::vector<Bytes>> TakeAll(udp::socket& end) {
    std::vector<std::vector<Bytes>> datagrams;
    for (Bytes bytes(2000);; bytes.resize(2000)) {
      asio::error_code error;
      bytes.resize(end.receive(asio::buffer(bytes), 0, error));
      if (error) return datagrams;
      EXPECT_LE(bytes.size(), protocol::kMaxDatagramBytes);
      protocol::Unbundler unbundler;
      EXPECT_EQ(unbundler.Open(bytes), protocol::BundleStatus::kOk);
      std::vector<Bytes>& messages = datagrams.emplace_back();
      std::span<const std::uint8_t> message;
      while (unbundler.Next(message)) messages.emplace_back(message.begin(), message.end());
    }
  }

  std::mt19937 random{3};
  std::uint32_t next_sequence = 0;
  asio::io_context io;
  udp::socket socket{io, udp::endpoint(asio::ip::address_v4::loopback(), 0)};
  udp::socket a{io, udp::endpoint(asio::ip::address_v4::loopback(), 0)};
  udp::socket b{io, udp::endpoint(asio::ip::address_v4::loopback(), 0)};
  UdpSender sender;
};

TEST_F(UdpBundlesTest, MessagesShareADatagramUntilItIsFull) {
  std::vector<Bytes> messages;
  for (int i = 0; i < 7; ++i) {
    messages.push_back(Message(400));
    Push(a, messages.back(), Packing::kBundled);
    Push(b, messages.back(), Packing::kSeparate);
  }
  sender.Flush();
  using Datagrams = std::vector<std::vector<Bytes>>;
  EXPECT_EQ(TakeAll(a), (Datagrams{{messages[0], messages[1], messages[2]},
                                   {messages[3], messages[4], messages[5]},
                                   {messages[6]}}));
  Datagrams alone;
  for (const Bytes& message : messages) alone.push_back({message});
  EXPECT_EQ(TakeAll(b), alone);
  const UdpSender::Counts counts = sender.TakeCounts();
  EXPECT_EQ(counts.sent, 10u);
  EXPECT_EQ(counts.bundled, 6u);
}

TEST_F(UdpBundlesTest, ASingleMessageIsNotBundled) {
  const Bytes message = Message(300);
  Push(a, message, Packing::kBundled);
  sender.Flush();
  Bytes got(2000);
  got.resize(a.receive(asio::buffer(got)));
  EXPECT_EQ(got, message);
  EXPECT_EQ(sender.TakeCounts().bundled, 0u);
}

TEST_F(UdpBundlesTest, OneByteTooManyStartsAnotherDatagram) {
  Push(a, Message(600), Packing::kBundled);
  Push(a, Message(600), Packing::kBundled);
  Push(b, Message(600), Packing::kBundled);
  Push(b, Message(601), Packing::kBundled);
  sender.Flush();
  EXPECT_EQ(TakeAll(a).size(), 1u);
  EXPECT_EQ(TakeAll(b).size(), 2u);
}

TEST_F(UdpBundlesTest, RandomMessagesArriveUnchangedAndInOrder) {
  for (int round = 0; round < 50; ++round) {
    std::map<udp::socket*, std::vector<Bytes>> sent;
    std::map<udp::socket*, std::size_t> alone;
    const bool equal_sizes = round % 2 == 0;  // equal sizes allow UDP_SEGMENT
    const std::size_t size = 40 + random() % 1161;
    for (int i = 0; i < 100; ++i) {
      udp::socket& end = random() % 2 == 0 ? a : b;
      const Packing packing = random() % 8 == 0 ? Packing::kSeparate : Packing::kBundled;
      const Bytes message = Message(equal_sizes ? size : 40 + random() % 1161);
      Push(end, message, packing);
      sent[&end].push_back(message);
      if (packing == Packing::kSeparate) ++alone[&end];
    }
    sender.Flush();
    std::size_t datagrams = 0;
    std::size_t bundled = 0;
    for (auto& [end, expected] : sent) {
      std::vector<Bytes> got;
      std::size_t singles = 0;
      for (const auto& messages : TakeAll(*end)) {
        ++datagrams;
        if (messages.size() > 1) bundled += messages.size();
        if (messages.size() == 1) ++singles;
        got.insert(got.end(), messages.begin(), messages.end());
      }
      EXPECT_EQ(got, expected);
      EXPECT_GE(singles, alone[end]);
    }
    const UdpSender::Counts counts = sender.TakeCounts();
    EXPECT_EQ(counts.sent, datagrams);
    EXPECT_EQ(counts.bundled, bundled);
    EXPECT_EQ(counts.lost, 0u);
  }
}

}  // namespace
}  // namespace furrow::server
