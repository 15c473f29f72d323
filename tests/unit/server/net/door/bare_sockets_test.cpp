// SPDX-License-Identifier: Apache-2.0
#include "server/net/door/bare_sockets.h"

#include <array>
#include <chrono>
#include <cstdint>
#include <list>
#include <string>
#include <vector>

#include <asio/buffer.hpp>
#include <asio/error.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/write.hpp>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "server/tls/handshake.h"
#include "tests/unit/allocation_counter.h"

namespace furrow::server {
namespace {

using asio::ip::tcp;
using Kind = BareSockets::Kind;

constexpr Time kNow = std::chrono::seconds(100);
const std::string kHello("\x16\x03\x01\x00\x04\x01\x02\x03\x04", 9);  // a whole record

class BareSocketsTest : public testing::Test {
 protected:
  // A client that connects and sends these bytes, which have then arrived.
  tcp::socket& Come(const std::string& host, const std::string& bytes, Time now = kNow) {
    tcp::socket& client = clients.emplace_back(loop);
    client.connect(acceptor.local_endpoint());
    tcp::socket server = acceptor.accept();
    numbers.push_back(server.release());
    sockets.Add(host, numbers.back(), now);
    Send(client, numbers.back(), bytes);
    return client;
  }
  // Sends, and waits until the bytes have arrived behind those that have.
  static void Send(tcp::socket& client, int number, const std::string& bytes) {
    const int before = Arrived(number);
    asio::write(client, asio::buffer(bytes));
    while (Arrived(number) < before + static_cast<int>(bytes.size())) {
    }
  }
  static int Arrived(int number) {
    int bytes = 0;
    ioctl(number, FIONREAD, &bytes);
    return bytes;
  }
  // Looks until something has happened, which the kernel may take a moment to show.
  std::vector<BareSockets::Event> AwaitEvents(Time now = kNow) {
    std::vector<BareSockets::Event> events;
    while (events.empty()) events = sockets.Look(now);
    return events;
  }

  BareSockets sockets;
  asio::io_context loop{1};
  tcp::acceptor acceptor{loop, tcp::endpoint(asio::ip::address_v4::loopback(), 0)};
  std::list<tcp::socket> clients;
  std::vector<int> numbers;  // of the sockets of the server
};

TEST_F(BareSocketsTest, AWholeMessageIsReady) {
  Come("a", kHello);
  Come("b", "");
  EXPECT_TRUE(sockets.Look(kNow).empty());
  EXPECT_EQ(sockets.HostsThatWait(), std::vector<std::string>{"a"});
  const int number = sockets.Take("a");
  EXPECT_EQ(number, numbers[0]);
  EXPECT_EQ(Arrived(number), 9) << "the handshake reads it";
  BareSockets::CloseSocket(number);
  EXPECT_TRUE(sockets.HostsThatWait().empty());
  EXPECT_FALSE(sockets.empty());
}

TEST_F(BareSocketsTest, HalfAMessageWaitsForItsRest) {
  for (std::size_t size = 1; size < kHello.size(); ++size) {
    tcp::socket& client = Come("a", kHello.substr(0, size));
    EXPECT_TRUE(sockets.Look(kNow).empty());
    EXPECT_TRUE(sockets.HostsThatWait().empty()) << size;
    Send(client, numbers.back(), kHello.substr(size));
    while (sockets.HostsThatWait().empty()) EXPECT_TRUE(sockets.Look(kNow).empty());
    BareSockets::CloseSocket(sockets.Take("a"));
  }
  EXPECT_TRUE(sockets.empty());
}

TEST_F(BareSocketsTest, PlainClientsAreFoundAndThenAwaited) {
  tcp::socket& client = Come("a", "GET / HTTP/1.1\r\n\r\n");
  auto events = AwaitEvents();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, Kind::kPlain);
  EXPECT_EQ(events[0].host, "a");
  Send(client, numbers[0], "more");
  EXPECT_TRUE(sockets.Look(kNow).empty());
  EXPECT_TRUE(sockets.HostsThatWait().empty());
  EXPECT_EQ(Arrived(numbers[0]), 0) << "closing with unread input would reset the connection";
  client.close();
  events = AwaitEvents();
  EXPECT_EQ(events[0].kind, Kind::kGone);
  sockets.Remove(events[0].host, events[0].socket);
  EXPECT_TRUE(sockets.empty());
}

TEST_F(BareSocketsTest, ClientsThatLeaveAreGone) {
  for (const std::string& bytes : {std::string(), kHello.substr(0, 3), kHello}) {
    Come("a", bytes).close();
    const auto events = AwaitEvents();
    ASSERT_EQ(events.size(), 1u);
    EXPECT_EQ(events[0].kind, Kind::kGone);
    sockets.Remove("a", events[0].socket);
  }
}

TEST_F(BareSocketsTest, TheTimeOfAllIsLimited) {
  Come("a", "");
  Come("b", kHello.substr(0, 4));
  Come("c", kHello);
  tcp::socket& plain = Come("d", "GET / HTTP/1.1\r\n\r\n");
  while (sockets.HostsThatWait().empty()) (void)sockets.Look(kNow);
  EXPECT_TRUE(sockets.Look(kNow + kHandshakeDeadline - Time(1)).empty());
  auto events = sockets.Look(kNow + kHandshakeDeadline);
  ASSERT_EQ(events.size(), 3u);
  const std::array<Kind, 3> expected{Kind::kSlow, Kind::kSlow, Kind::kGone};
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(events[i].kind, expected[i]) << i;
    sockets.Remove(events[i].host, events[i].socket);
  }
  EXPECT_TRUE(sockets.Look(kNow + BareSockets::kPlaceDeadline - Time(1)).empty());
  events = sockets.Look(kNow + BareSockets::kPlaceDeadline);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, Kind::kBusy) << "a client that has spoken waits for its turn";
  sockets.Remove(events[0].host, events[0].socket);
  EXPECT_TRUE(sockets.empty());
  asio::error_code error;
  char byte = 0;
  plain.read_some(asio::buffer(&byte, 1), error);
  EXPECT_EQ(error, asio::error::eof) << "it was closed";
}

TEST_F(BareSocketsTest, TheFirstAndTheLastOfAHostComeInTurn) {
  for (int i = 0; i < 5; ++i) Come("a", kHello);
  while (sockets.HostsThatWait().empty()) (void)sockets.Look(kNow);
  for (const std::size_t expected : {0, 4, 1, 3, 2}) {
    const int number = sockets.Take("a");
    EXPECT_EQ(number, numbers[expected]);
    BareSockets::CloseSocket(number);
  }
  EXPECT_TRUE(sockets.empty());
}

// As when a place becomes free from time to time: no host is always the last one.
TEST_F(BareSocketsTest, HostsHaveTheirTurn) {
  for (int i = 0; i < 2; ++i) {
    for (const char* host : {"a", "b", "c"}) Come(host, kHello);
  }
  while (sockets.HostsThatWait().size() < 3) (void)sockets.Look(kNow);
  (void)sockets.Look(kNow);
  std::string turns;
  while (!sockets.HostsThatWait().empty()) {
    turns += sockets.HostsThatWait().front();
    BareSockets::CloseSocket(sockets.Take(sockets.HostsThatWait().front()));
  }
  EXPECT_EQ(turns, "abcabc");
}

TEST_F(BareSocketsTest, ClosingTellsTheHosts) {
  Come("b", "");
  Come("a", kHello);
  Come("b", kHello);
  std::string closed;
  sockets.Close([&closed](const std::string& host) { closed += host; });
  EXPECT_EQ(closed, "abb");
  EXPECT_TRUE(sockets.empty());
  for (tcp::socket& client : clients) {
    asio::error_code error;
    char byte = 0;
    client.read_some(asio::buffer(&byte, 1), error);
    EXPECT_TRUE(error);
  }
}

TEST_F(BareSocketsTest, LackOfMemoryLeavesTheSocketWithTheCaller) {
  const test::AllocationLimit limit(0);
  EXPECT_THROW(sockets.Add("a", -1, kNow), std::bad_alloc);
  EXPECT_TRUE(sockets.empty());
}

}  // namespace
}  // namespace furrow::server
