// SPDX-License-Identifier: Apache-2.0
#include "server/net/door/tcp_progress.h"

#include <chrono>
#include <string>

#include <asio/buffer.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/read.hpp>
#include <asio/write.hpp>
#include <gtest/gtest.h>

namespace furrow::server {
namespace {

using asio::ip::tcp;

TEST(TcpProgress, CountsBothDirections) {
  asio::io_context loop{1};
  tcp::acceptor acceptor(loop, tcp::endpoint(asio::ip::address_v4::loopback(), 0));
  tcp::socket client(loop);
  client.connect(acceptor.local_endpoint());
  tcp::socket server = acceptor.accept();
  const StrangerPatience::Client before = ReadTcpProgress(server.native_handle());
  EXPECT_LE(before.bytes, 1u);  // the kernel may count the beginning of the connection
  EXPECT_GT(before.round_trip, Time(0));
  EXPECT_LT(before.round_trip, std::chrono::minutes(1));
  std::string bytes(1000, 'a');
  asio::write(client, asio::buffer(bytes));
  asio::read(server, asio::buffer(bytes));
  EXPECT_EQ(ReadTcpProgress(server.native_handle()).bytes, before.bytes + 1000);
  asio::write(server, asio::buffer(bytes, 500));
  asio::read(client, asio::buffer(bytes, 500));
  // The kernel of the client acknowledges them on its own.
  while (ReadTcpProgress(server.native_handle()).bytes < before.bytes + 1500) {
  }
}

TEST(TcpProgress, AClosedSocketHasNone) {
  EXPECT_EQ(ReadTcpProgress(-1).bytes, 0u);
  EXPECT_EQ(ReadTcpProgress(-1).round_trip, Time(0));
}

}  // namespace
}  // namespace furrow::server
