// SPDX-License-Identifier: Apache-2.0
#include "server/net/udp/udp_batch.h"

#include <vector>

#include <asio/io_context.hpp>
#include <gtest/gtest.h>

namespace furrow::server {
namespace {

using asio::ip::udp;

class UdpBatchTest : public testing::Test {
 protected:
  void SetUp() override {
    UdpBatch::CountDropped(receiver.native_handle());
    receiver.non_blocking(true);
  }
  void Send(std::size_t size) {
    sender.send_to(asio::buffer(std::vector<std::uint8_t>(size, 7)), receiver.local_endpoint());
  }
  std::size_t ReceiveAll() {
    std::size_t all = 0;
    while (const std::size_t count = batch.Receive(receiver.native_handle())) all += count;
    return all;
  }

  asio::io_context io;
  udp::socket receiver{io, udp::endpoint(asio::ip::address_v4::loopback(), 0)};
  udp::socket sender{io, udp::endpoint(asio::ip::address_v4::loopback(), 0)};
  UdpBatch batch;
};

TEST_F(UdpBatchTest, ReturnsBytesAndSendersAndMarksOversizedDatagrams) {
  Send(3);
  Send(protocol::kMaxDatagramBytes);
  Send(protocol::kMaxDatagramBytes + 500);
  ASSERT_EQ(batch.Receive(receiver.native_handle()), 3u);
  EXPECT_EQ(batch.bytes(0).size(), 3u);
  EXPECT_EQ(batch.bytes(0)[2], 7);
  EXPECT_EQ(batch.bytes(1).size(), protocol::kMaxDatagramBytes);
  EXPECT_EQ(batch.bytes(2).size(), protocol::secure::kMaxPacketBytes + 1);
  EXPECT_EQ(batch.sender(2), sender.local_endpoint());
  EXPECT_EQ(batch.Receive(receiver.native_handle()), 0u);
  EXPECT_EQ(batch.TakeDropped(), 0u);
}

TEST_F(UdpBatchTest, CountsDatagramsLostInTheSocketBuffer) {
  receiver.set_option(asio::socket_base::receive_buffer_size(4096));
  for (int round = 0; round < 2; ++round) {
    for (int i = 0; i < 100; ++i) Send(1000);
    std::size_t received = ReceiveAll();
    Send(1);  // carries the count of the datagrams lost before
    received += ReceiveAll();
    EXPECT_LT(received, 101u);
    EXPECT_EQ(received + batch.TakeDropped(), 101u);
    EXPECT_EQ(batch.TakeDropped(), 0u);
  }
}

}  // namespace
}  // namespace furrow::server
