// SPDX-License-Identifier: Apache-2.0
#include "server/net/door/handshake_gate.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <list>
#include <optional>
#include <string>
#include <vector>

#include <asio/awaitable.hpp>
#include <asio/buffer.hpp>
#include <asio/co_spawn.hpp>
#include <asio/error.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/steady_timer.hpp>
#include <asio/write.hpp>
#include <gtest/gtest.h>

#include "server/net/asio_net.h"
#include "server/tls/handshake_places.h"
#include "tests/unit/server/net/door/run_until.h"

namespace furrow::server {
namespace {

using asio::ip::tcp;

constexpr std::array<std::uint8_t, 5> kHello{22, 3, 1, 2, 0};  // the head of a ClientHello

// A connection with a handshake that the test ends.
struct Connection {
  explicit Connection(asio::io_context& loop)
      : client(loop), server(loop), end(loop, asio::steady_timer::time_point::max()) {}

  tcp::socket& socket() { return server; }
  asio::awaitable<asio::error_code> Handshake(TlsContext) {
    begins = true;
    asio::error_code ignored;
    co_await end.async_wait(AsioNet::Redirect(ignored));
    co_return result;
  }

  tcp::socket client;
  tcp::socket server;
  asio::steady_timer end;  // of the handshake, when it is cancelled
  asio::error_code result;
  bool begins = false;
  std::optional<bool> passed;
};

class HandshakeGateTest : public testing::Test {
 protected:
  // A connection at the gate.
  Connection& Come() {
    Connection& connection = connections.emplace_back(loop);
    connection.client.connect(acceptor.local_endpoint());
    acceptor.accept(connection.server);
    asio::co_spawn(loop, gate.Pass(connection, host),
                   [&connection](const std::exception_ptr& failed, bool passed) {
                     EXPECT_TRUE(failed == nullptr);
                     connection.passed = passed;
                   });
    return connection;
  }
  Connection& ComeWithHello() {
    Connection& connection = Come();
    asio::write(connection.client, asio::buffer(kHello));
    return connection;
  }
  [[nodiscard]] bool RunUntilItPassed(const Connection& connection) {
    return RunUntil(loop, [&connection] { return connection.passed.has_value(); });
  }

  const std::string host = "127.0.0.1";
  Metrics metrics;
  int plain_answers = 0;
  int contexts = 0;
  HandshakeGate<AsioNet> gate{
      HandshakeGate<AsioNet>::Parts{.metrics = &metrics,
                                    .context =
                                        [this] {
                                          ++contexts;
                                          return TlsContext();
                                        },
                                    .answer_plain =
                                        [this](tcp::socket& socket) {
                                          ++plain_answers;
                                          asio::error_code ignored;
                                          socket.shutdown(tcp::socket::shutdown_send, ignored);
                                        }}};
  asio::io_context loop{1};
  tcp::acceptor acceptor{loop, tcp::endpoint(asio::ip::address_v4::loopback(), 0)};
  std::list<Connection> connections;
};

TEST_F(HandshakeGateTest, AHandshakePasses) {
  Connection& connection = ComeWithHello();
  ASSERT_TRUE(RunUntil(loop, [&] { return connection.begins; }));
  EXPECT_EQ(contexts, 1);
  // The handshake reads what the gate has looked at.
  std::array<std::uint8_t, kHello.size()> read{};
  EXPECT_EQ(connection.server.available(), kHello.size());
  EXPECT_EQ(connection.server.read_some(asio::buffer(read)), kHello.size());
  EXPECT_EQ(read, kHello);
  connection.end.cancel();
  ASSERT_TRUE(RunUntilItPassed(connection));
  EXPECT_TRUE(*connection.passed);
  EXPECT_EQ(metrics.Get(Counter::kTlsHandshakes), 1u);
}

TEST_F(HandshakeGateTest, AFailureIsCounted) {
  Connection& connection = ComeWithHello();
  connection.result = asio::error::eof;
  ASSERT_TRUE(RunUntil(loop, [&] { return connection.begins; }));
  connection.end.cancel();
  ASSERT_TRUE(RunUntilItPassed(connection));
  EXPECT_FALSE(*connection.passed);
  EXPECT_EQ(metrics.Get(Counter::kTlsFailed), 1u);
  EXPECT_EQ(metrics.Get(Counter::kTlsHandshakes), 0u);
  EXPECT_EQ(metrics.Get(Counter::kTlsSlow), 0u);
}

TEST_F(HandshakeGateTest, APlainClientGetsOneAnswerAndTimeToReadIt) {
  Connection& connection = Come();
  asio::write(connection.client, asio::buffer("GET / HTTP/1.1\r\n\r\n", 18));
  ASSERT_TRUE(RunUntil(loop, [this] { return plain_answers == 1; }));
  EXPECT_FALSE(connection.passed.has_value()) << "it waits until the client closes";
  asio::error_code error;
  char byte = 0;
  connection.client.read_some(asio::buffer(&byte, 1), error);
  EXPECT_EQ(error, asio::error::eof);
  connection.client.close();
  ASSERT_TRUE(RunUntilItPassed(connection));
  EXPECT_FALSE(*connection.passed);
  EXPECT_FALSE(connection.begins);
  EXPECT_EQ(metrics.Get(Counter::kTlsPlain), 1u);
}

TEST_F(HandshakeGateTest, AClientThatClosesAtOnceIsNoFailure) {
  Connection& connection = Come();
  connection.client.close();
  ASSERT_TRUE(RunUntilItPassed(connection));
  EXPECT_FALSE(*connection.passed);
  EXPECT_FALSE(connection.begins);
  EXPECT_EQ(plain_answers, 0);
  for (const Counter counter : {Counter::kTlsPlain, Counter::kTlsSlow, Counter::kTlsFailed}) {
    EXPECT_EQ(metrics.Get(counter), 0u);
  }
}

TEST_F(HandshakeGateTest, HandshakesWaitForAPlace) {
  constexpr std::size_t kMost = HandshakePlaces::kPlaces / 2;  // of one host
  std::vector<Connection*> under_way;
  for (std::size_t i = 0; i < kMost; ++i) under_way.push_back(&ComeWithHello());
  for (const Connection* each : under_way) {
    ASSERT_TRUE(RunUntil(loop, [each] { return each->begins; }));
  }
  Connection& last = ComeWithHello();
  for (int polls = 0; polls < 3; ++polls) loop.run_one_for(HandshakePlaces::kPoll);
  EXPECT_FALSE(last.begins);
  under_way.front()->end.cancel();
  ASSERT_TRUE(RunUntilItPassed(*under_way.front()));
  EXPECT_TRUE(RunUntil(loop, [&last] { return last.begins; }));
}

}  // namespace
}  // namespace furrow::server
