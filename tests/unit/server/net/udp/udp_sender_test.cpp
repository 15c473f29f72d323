// SPDX-License-Identifier: Apache-2.0
#include "server/net/udp/udp_sender.h"

#include <algorithm>
#include <deque>
#include <utility>
#include <vector>

#include <asio/io_context.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "protocol/secure/packet/packet.h"

namespace furrow::server {
namespace {

using asio::ip::udp;
using testing::ElementsAre;

struct FarEnd {
  explicit FarEnd(asio::io_context& io)
      : socket(io, udp::endpoint(asio::ip::address_v4::loopback(), 0)) {
    socket.set_option(asio::socket_base::receive_buffer_size(1 << 20));
    socket.non_blocking(true);
  }
  // Size and first byte of each datagram.
  std::vector<std::pair<std::size_t, int>> TakeAll() {
    std::vector<std::pair<std::size_t, int>> all;
    std::vector<std::uint8_t> bytes(2000);
    for (;;) {
      asio::error_code error;
      const std::size_t size = socket.receive(asio::buffer(bytes), 0, error);
      if (error) return all;
      all.emplace_back(size, bytes[0]);
    }
  }
  udp::socket socket;
};

class UdpSenderTest : public testing::Test {
 protected:
  void SetUp() override {
    socket.non_blocking(true);
    sender.Open(socket.native_handle());
  }
  void Push(std::uint64_t key, const udp::endpoint& to, std::size_t size, int first) {
    const auto bytes = sender.Prepare();
    ASSERT_EQ(bytes.size(), protocol::kMaxDatagramBytes);
    bytes[0] = static_cast<std::uint8_t>(first);
    sender.Commit(key, to, size);
  }
  void Push(std::uint64_t key, FarEnd& end, std::size_t size, int first) {
    Push(key, end.socket.local_endpoint(), size, first);
  }

  asio::io_context io;
  udp::socket socket{io, udp::endpoint(asio::ip::address_v4::loopback(), 0)};
  FarEnd a{io};
  FarEnd b{io};
  UdpSender sender;
};

TEST_F(UdpSenderTest, DatagramsArriveWholeAndInOrder) {
  Push(1, a, 100, 1);
  Push(2, b, 100, 2);
  Push(1, a, 100, 3);
  Push(1, a, 40, 4);
  Push(2, b, 200, 5);
  Push(1, a, 100, 6);
  Push(1, a, 1200, 7);
  EXPECT_TRUE(a.TakeAll().empty()) << "nothing leaves before it is asked to";
  sender.Flush();
  using P = std::pair<std::size_t, int>;
  EXPECT_THAT(a.TakeAll(), ElementsAre(P(100, 1), P(100, 3), P(40, 4), P(100, 6), P(1200, 7)));
  EXPECT_THAT(b.TakeAll(), ElementsAre(P(100, 2), P(200, 5)));
  const UdpSender::Counts counts = sender.TakeCounts();
  EXPECT_EQ(counts.sent, 7u);
  EXPECT_EQ(counts.lost, 0u);
  EXPECT_EQ(sender.TakeCounts().sent, 0u);
  sender.Flush();
  EXPECT_TRUE(a.TakeAll().empty());
}

TEST_F(UdpSenderTest, AFullBufferFlushes) {
  // Few enough bytes for the socket buffers, so that all of them arrive.
  constexpr int kEach = 400;
  std::deque<FarEnd> ends;
  for (int i = 0; i < 16; ++i) ends.emplace_back(io);
  for (int number = 0; number < kEach; ++number) {
    for (std::size_t i = 0; i < ends.size(); ++i) Push(i, ends[i], 100, number % 256);
  }
  EXPECT_GT(sender.TakeCounts().sent, 0u) << "before it was asked to";
  sender.Flush();
  for (FarEnd& end : ends) {
    const auto got = end.TakeAll();
    ASSERT_EQ(got.size(), std::size_t{kEach});
    for (int number = 0; number < kEach; ++number) {
      EXPECT_EQ(got[static_cast<std::size_t>(number)], std::pair(std::size_t{100}, number % 256));
    }
  }
}

TEST_F(UdpSenderTest, AFullAddressTableFlushes) {
  constexpr std::uint64_t kAddresses = 3000;  // all for one socket: only the keys differ
  for (std::uint64_t key = 0; key < kAddresses; ++key) {
    Push(key << 20, key % 2 == 0 ? a : b, 40, 1);  // keys that collide
    if (key % 200 == 0) sender.Flush();
    EXPECT_LE(a.TakeAll().size() + b.TakeAll().size(), 400u);
  }
  sender.Flush();
  EXPECT_EQ(sender.TakeCounts().sent, kAddresses);
}

TEST_F(UdpSenderTest, UnsendableDatagramsAreCountedAndOthersLeave) {
  Push(1, udp::endpoint(asio::ip::make_address_v4("255.255.255.255"), 9), 50,
       1);  // broadcast is not permitted
  Push(2, a, 60, 2);
  Push(3, udp::endpoint(asio::ip::address_v6::loopback(), 9), 70, 3);  // another address family
  Push(4, b, 80, 4);
  sender.Flush();
  EXPECT_EQ(a.TakeAll().size(), 1u);
  EXPECT_EQ(b.TakeAll().size(), 1u);
  const UdpSender::Counts counts = sender.TakeCounts();
  EXPECT_EQ(counts.sent, 2u);
  EXPECT_EQ(counts.lost, 2u);
}

// "Seals" by the number of the session in the first byte, and knows where its client is now.
class FakeSealer : public DatagramSealer {
 public:
  bool Seal(std::uint32_t session, std::span<std::uint8_t> packet, udp::endpoint& to) override {
    if (session == 9) return false;
    packet[0] = static_cast<std::uint8_t>(session);
    inner.emplace_back(packet.begin() + protocol::secure::kPacketHeaderBytes,
                       packet.end() - protocol::secure::kTagBytes);
    to = where;
    return true;
  }
  udp::endpoint where;
  std::vector<std::vector<std::uint8_t>> inner;
};

TEST_F(UdpSenderTest, SealsWholeDatagramsAndSendsThemWhereTheClientIs) {
  FakeSealer sealer;
  sealer.where = b.socket.local_endpoint();
  sender.SetSealer(&sealer);
  const auto push = [&](std::uint64_t key, std::uint32_t session, std::size_t size, int first) {
    const auto bytes = sender.Prepare();
    std::fill_n(bytes.begin(), size, static_cast<std::uint8_t>(first));
    sender.Commit(key, a.socket.local_endpoint(), size, Packing::kSeparate, session);
  };
  push(1, 5, 100, 1);
  push(1, 5, 100, 2);
  push(1, 5, 40, 3);
  push(2, 9, 100, 4);  // its session has ended
  push(3, 0, 100, 5);
  sender.Flush();
  using P = std::pair<std::size_t, int>;
  EXPECT_THAT(b.TakeAll(), ElementsAre(P(132, 5), P(132, 5), P(72, 5)));
  EXPECT_THAT(a.TakeAll(), ElementsAre(P(100, 5))) << "plain, at its own address";
  ASSERT_EQ(sealer.inner.size(), 3u);
  EXPECT_EQ(sealer.inner[1], std::vector<std::uint8_t>(100, 2));
  const UdpSender::Counts counts = sender.TakeCounts();
  EXPECT_EQ(counts.sent, 4u);
  EXPECT_EQ(counts.lost, 1u);
}

}  // namespace
}  // namespace furrow::server
