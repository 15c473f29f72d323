// SPDX-License-Identifier: Apache-2.0
#include "client/net/udp_socket.h"

#include <memory>
#include <vector>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "client/net/clock.h"
#include "client/net/open_socket.h"
#include "protocol/codec/codec.h"

namespace furrow::net {
namespace {

using client::IoStatus;
using Bytes = std::vector<std::uint8_t>;

// A connected pair of sockets. The far end is a plain system socket.
class UdpSocketTest : public testing::Test {
 protected:
  void SetUp() override {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    auto* const plain = reinterpret_cast<sockaddr*>(&address);
    ASSERT_EQ(bind(far_.get(), plain, sizeof(address)), 0);
    socklen_t size = sizeof(address);
    getsockname(far_.get(), plain, &size);
    auto opened = OpenSocket(client::TransportKind::kUdp, "127.0.0.1", ntohs(address.sin_port));
    ASSERT_TRUE(opened.ok()) << opened.status().ToString();
    near_ = *std::move(opened);
    getsockname(near_->descriptor(), plain, &size);
    ASSERT_EQ(connect(far_.get(), plain, size), 0);
  }
  void FromFar(const Bytes& datagram) {
    ASSERT_EQ(send(far_.get(), datagram.data(), datagram.size(), 0),
              static_cast<ssize_t>(datagram.size()));
  }
  Bytes Take() {
    std::span<const std::uint8_t> message;
    EXPECT_EQ(near_->Receive(message, std::chrono::milliseconds(0)), IoStatus::kOk);
    return {message.begin(), message.end()};
  }

  Descriptor far_{socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  std::unique_ptr<Socket> near_;
};

TEST_F(UdpSocketTest, SplitsBundlesAndReportsRemainingMessages) {
  std::vector<Bytes> messages(3);
  for (std::uint32_t i = 0; i < 3; ++i)
    protocol::Encoder().Encode({.session = 3, .sequence = i}, protocol::Ping{i}, messages[i]);
  Bytes bundle;
  ASSERT_TRUE(protocol::WriteBundle(messages, bundle));
  EXPECT_TRUE(near_->takes_bundles());
  EXPECT_FALSE(near_->holds());
  FromFar(bundle);
  EXPECT_FALSE(near_->holds()) << "the descriptor reports it";
  EXPECT_EQ(Take(), messages[0]);
  EXPECT_TRUE(near_->holds());
  EXPECT_EQ(Take(), messages[1]);
  EXPECT_TRUE(near_->holds());
  EXPECT_EQ(Take(), messages[2]);
  EXPECT_FALSE(near_->holds());
  FromFar(messages[1]);
  FromFar(bundle);
  std::span<const std::uint8_t> message;
  EXPECT_EQ(near_->Receive(message, std::chrono::milliseconds(0)), IoStatus::kTimeout)
      << "later datagrams are read after the next wait";
  EXPECT_EQ(Take(), messages[1]);
  EXPECT_TRUE(near_->holds()) << "another datagram of the same batch";
  for (const Bytes& each : messages) EXPECT_EQ(Take(), each);
  EXPECT_FALSE(near_->holds());
}

// A late read must not change the measured arrival time.
TEST_F(UdpSocketTest, ArrivalTimeIsThatOfTheDatagramNotOfTheRead) {
  Bytes message;
  protocol::Encoder().Encode({.session = 3, .sequence = 1}, protocol::Ping{1}, message);
  const std::int64_t before = SteadyNanoseconds();
  FromFar(message);
  FromFar(message);
  EXPECT_EQ(Take(), message);
  const std::int64_t first = near_->arrived_ns();
  EXPECT_TRUE(near_->holds()) << "both were read in one batch";
  EXPECT_EQ(Take(), message);
  EXPECT_GE(first, before);
  EXPECT_GT(near_->arrived_ns(), first);
  EXPECT_LE(near_->arrived_ns(), SteadyNanoseconds());
}

}  // namespace
}  // namespace furrow::net
