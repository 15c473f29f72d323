// SPDX-License-Identifier: Apache-2.0
#include "server/net/door/handshake_gate.h"

#include <array>
#include <chrono>
#include <cstddef>
#include <exception>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <utility>
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
#include <linux/sockios.h>
#include <sys/ioctl.h>

#include "server/net/asio_net.h"
#include "server/tls/handshake_places.h"
#include "server/tls/stranger_patience.h"
#include "tests/unit/server/net/door/run_until.h"

namespace furrow::server {
namespace {

using asio::ip::tcp;

// A connection with a handshake that the test ends.
struct Connection {
  Connection(asio::io_context& loop, tcp::socket accepted)
      : server(std::move(accepted)), end(loop, asio::steady_timer::time_point::max()) {}

  tcp::socket& socket() { return server; }
  asio::awaitable<asio::error_code> Handshake(TlsContext) {
    begins = true;
    asio::error_code ignored;
    co_await end.async_wait(AsioNet::Redirect(ignored));
    co_return result;
  }
  void Hold(std::shared_ptr<Stranger> held) { stranger = std::move(held); }

  tcp::socket server;
  asio::steady_timer end;  // of the handshake, when it is cancelled
  asio::error_code result;
  bool begins = false;
  std::optional<bool> passed;
  std::shared_ptr<Stranger> stranger;
};

// Its timers may lack memory.
struct PoorNet : AsioNet {
  struct Timer : asio::steady_timer {
    using asio::steady_timer::basic_waitable_timer;
    template <class Handler>
    void async_wait(Handler handler) {
      if (lacks_memory) throw std::bad_alloc();
      asio::steady_timer::async_wait(std::move(handler));
    }
    static inline bool lacks_memory = false;
  };
};

class HandshakeGateTest : public testing::Test {
 protected:
  const std::string kHello{"\x16\x03\x01\x00\x02\x01\x02", 7};  // a whole record

  HandshakeGate<AsioNet>::Parts Parts() {
    return {.metrics = &metrics,
            .places = &places,
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
                },
            .begin =
                [this](tcp::socket socket, const std::string& host,
                       HandshakeGate<AsioNet>::Place place) {
                  if (lacks_memory) throw std::bad_alloc();
                  Connection& connection = connections.emplace_back(loop, std::move(socket));
                  asio::co_spawn(loop, gate.Pass(connection, std::move(place)),
                                 [&connection](const std::exception_ptr& failed, bool passed) {
                                   EXPECT_TRUE(failed == nullptr);
                                   connection.passed = passed;
                                 });
                  hosts.push_back(host);
                },
            .ended = [this](const std::string& host) { ended.push_back(host); },
            .clock = [this] { return now; },
            .budget = {}};
  }
  // A client that comes to the gate and sends these bytes, which have then arrived.
  tcp::socket& Come(const std::string& host, const std::string& bytes) {
    return Come(&gate, host, bytes);
  }
  template <class Gate>
  tcp::socket& Come(Gate* to, const std::string& host, const std::string& bytes) {
    tcp::socket& client = clients.emplace_back(loop);
    client.connect(acceptor.local_endpoint());
    to->Enter(acceptor.accept(), host);
    asio::write(client, asio::buffer(bytes));
    int waiting = 1;  // bytes that have not arrived
    while (waiting > 0) ioctl(client.native_handle(), SIOCOUTQ, &waiting);
    return client;
  }
  tcp::socket& ComeWithHello(const std::string& host = "a") { return Come(host, kHello); }
  // The handshake that begins next.
  Connection* AwaitBegin() {
    const std::size_t number = connections.size() + 1;
    const bool begun =
        RunUntil(loop, [&] { return connections.size() == number && connections.back().begins; });
    EXPECT_TRUE(begun);
    return begun ? &connections.back() : nullptr;
  }
  // Lets the gate look: its timer expires before this one.
  void LetTheGateLook() {
    bool is_over = false;
    asio::steady_timer timer(loop, 2 * HandshakeGate<AsioNet>::kPoll);
    timer.async_wait([&](const asio::error_code&) { is_over = true; });
    ASSERT_TRUE(RunUntil(loop, [&] { return is_over; }));
  }
  // Ends the handshake. The place stays with the connection if it passes.
  void End(Connection* connection) {
    connection->end.cancel();
    ASSERT_TRUE(RunUntil(loop, [&] { return connection->passed.has_value(); }));
  }

  Metrics metrics;
  HandshakePlaces places;
  Time now = std::chrono::seconds(100);
  int plain_answers = 0;
  int contexts = 0;
  bool lacks_memory = false;
  std::vector<std::string> hosts;  // of handshakes that have begun
  std::vector<std::string> ended;
  asio::io_context loop{1};
  HandshakeGate<AsioNet> gate{loop, Parts()};
  tcp::acceptor acceptor{loop, tcp::endpoint(asio::ip::address_v4::loopback(), 0)};
  std::list<tcp::socket> clients;
  std::list<Connection> connections;
};

TEST_F(HandshakeGateTest, AHandshakePasses) {
  ComeWithHello();
  Connection* const connection = AwaitBegin();
  ASSERT_NE(connection, nullptr);
  EXPECT_EQ(contexts, 1);
  // The handshake reads what the gate has looked at.
  std::array<char, 7> read{};
  EXPECT_EQ(connection->server.read_some(asio::buffer(read)), read.size());
  EXPECT_EQ(std::string(read.data(), read.size()), kHello);
  End(connection);
  EXPECT_TRUE(*connection->passed);
  EXPECT_EQ(metrics.Get(Counter::kTlsHandshakes), 1u);
  EXPECT_EQ(hosts, std::vector<std::string>{"a"});
  EXPECT_TRUE(ended.empty());
}

TEST_F(HandshakeGateTest, AFailureIsCounted) {
  ComeWithHello();
  Connection* const connection = AwaitBegin();
  ASSERT_NE(connection, nullptr);
  connection->result = asio::error::eof;
  End(connection);
  EXPECT_FALSE(*connection->passed);
  EXPECT_EQ(metrics.Get(Counter::kTlsFailed), 1u);
  EXPECT_EQ(metrics.Get(Counter::kTlsHandshakes), 0u);
  EXPECT_EQ(metrics.Get(Counter::kTlsSlow), 0u);
  EXPECT_NE(places.Enter("a"), nullptr) << "the place is free";
}

TEST_F(HandshakeGateTest, APlainClientGetsOneAnswerAndTimeToReadIt) {
  tcp::socket& client = Come("a", "GET / HTTP/1.1\r\n\r\n");
  ASSERT_TRUE(RunUntil(loop, [this] { return plain_answers == 1; }));
  LetTheGateLook();
  EXPECT_TRUE(ended.empty()) << "it waits until the client closes";
  asio::error_code error;
  char byte = 0;
  client.read_some(asio::buffer(&byte, 1), error);
  EXPECT_EQ(error, asio::error::eof);
  client.close();
  ASSERT_TRUE(RunUntil(loop, [this] { return ended.size() == 1; }));
  EXPECT_TRUE(connections.empty());
  EXPECT_EQ(plain_answers, 1);
  EXPECT_EQ(metrics.Get(Counter::kTlsPlain), 1u);
}

TEST_F(HandshakeGateTest, AClientThatClosesAtOnceIsNoFailure) {
  Come("a", "").close();
  ASSERT_TRUE(RunUntil(loop, [this] { return ended.size() == 1; }));
  EXPECT_TRUE(connections.empty());
  EXPECT_EQ(plain_answers, 0);
  for (const Counter counter : {Counter::kTlsPlain, Counter::kTlsSlow, Counter::kTlsFailed}) {
    EXPECT_EQ(metrics.Get(counter), 0u);
  }
}

TEST_F(HandshakeGateTest, HandshakesOfAHostBeginOneAfterTheOther) {
  ComeWithHello();
  Connection* const first = AwaitBegin();
  ASSERT_NE(first, nullptr);
  ComeWithHello();
  LetTheGateLook();
  EXPECT_EQ(connections.size(), 1u);
  // Another host need not wait.
  ComeWithHello("b");
  ASSERT_NE(AwaitBegin(), nullptr);
  EXPECT_EQ(hosts.back(), "b");
  // A stranger keeps its place until it has shown who it is.
  End(first);
  ASSERT_NE(first->stranger, nullptr);
  LetTheGateLook();
  EXPECT_EQ(connections.size(), 2u);
  EXPECT_TRUE(first->stranger->IsWanted());
  first->stranger.reset();  // Admit()
  ASSERT_NE(AwaitBegin(), nullptr);
  EXPECT_EQ(hosts.back(), "a");
}

TEST_F(HandshakeGateTest, SilentClientsAndHalfMessagesKeepNobodyWaiting) {
  for (int i = 0; i < 20; ++i) {
    Come("a", "");
    Come("a", kHello.substr(0, 4));
  }
  ComeWithHello();
  EXPECT_NE(AwaitBegin(), nullptr);
}

// A stranger that does not answer gives way to others of its host. The time that it has depends on
// the round trip.
TEST_F(HandshakeGateTest, AStalledHandshakeGivesWayIfOthersWait) {
  ComeWithHello();
  Connection* const stalled = AwaitBegin();
  ASSERT_NE(stalled, nullptr);
  ComeWithHello();
  LetTheGateLook();
  EXPECT_TRUE(stalled->server.is_open());
  now += StrangerPatience::kMostSilence;
  ASSERT_TRUE(RunUntil(loop, [&] { return !stalled->server.is_open(); }));
  stalled->result = asio::error::operation_aborted;
  End(stalled);
  EXPECT_FALSE(*stalled->passed);
  EXPECT_EQ(metrics.Get(Counter::kTlsSlow), 1u);
  EXPECT_NE(AwaitBegin(), nullptr);
}

TEST_F(HandshakeGateTest, AStrangerThatShowsNothingGivesWayIfOthersWait) {
  ComeWithHello();
  Connection* const stranger = AwaitBegin();
  ASSERT_NE(stranger, nullptr);
  End(stranger);
  ComeWithHello();
  LetTheGateLook();
  EXPECT_TRUE(stranger->server.is_open());
  now += StrangerPatience::kMostSilence;
  ASSERT_TRUE(RunUntil(loop, [&] { return !stranger->server.is_open(); }));
  EXPECT_EQ(metrics.Get(Counter::kConnectionsGaveWay), 1u);
  EXPECT_EQ(metrics.Get(Counter::kTlsSlow), 0u);
  stranger->stranger.reset();
  EXPECT_NE(AwaitBegin(), nullptr);
}

TEST_F(HandshakeGateTest, AHostHasSeveralPlacesIfTheyAreAllowed) {
  places.SetPlacesOfHost(2);
  for (int i = 0; i < 3; ++i) ComeWithHello();
  ASSERT_TRUE(RunUntil(loop, [this] { return connections.size() == 2; }));
  LetTheGateLook();
  EXPECT_EQ(connections.size(), 2u);
}

// All places are taken, and one after the other becomes free.
TEST_F(HandshakeGateTest, WaitingHostsHaveTheirTurn) {
  std::vector<HandshakeGate<AsioNet>::Place> held;
  for (std::size_t i = 0; i < HandshakePlaces::kPlaces; ++i) {
    held.push_back(places.Enter("other " + std::to_string(i)));
  }
  for (int i = 0; i < 2; ++i) {
    for (const char* host : {"a", "b", "c"}) ComeWithHello(host);
  }
  LetTheGateLook();
  EXPECT_TRUE(connections.empty());
  EXPECT_TRUE(held[1]->IsWanted());
  held.pop_back();
  for (int i = 0; i < 6; ++i) {
    Connection* const next = AwaitBegin();
    ASSERT_NE(next, nullptr);
    LetTheGateLook();
    EXPECT_EQ(connections.size(), static_cast<std::size_t>(i) + 1);
    End(next);
    next->stranger.reset();
  }
  EXPECT_EQ(hosts, (std::vector<std::string>{"a", "b", "c", "a", "b", "c"}));
}

TEST_F(HandshakeGateTest, AHostHasABudget) {
  HandshakeGate<AsioNet>::Parts parts = Parts();
  while (parts.budget.Take("192.0.2.1", now)) {
  }
  HandshakeGate<AsioNet> drained(loop, std::move(parts));
  Come(&drained, "192.0.2.1", kHello);
  ASSERT_TRUE(RunUntil(loop, [this] { return !ended.empty(); }));
  EXPECT_EQ(ended, std::vector<std::string>{"192.0.2.1"});
  EXPECT_EQ(metrics.Get(Counter::kTlsBusy), 1u);
  EXPECT_TRUE(connections.empty());
  Come(&drained, "192.0.2.2", kHello);
  EXPECT_NE(AwaitBegin(), nullptr) << "another host has its own";
  EXPECT_EQ(hosts, std::vector<std::string>{"192.0.2.2"});
}

TEST_F(HandshakeGateTest, LackOfMemoryEndsOneConnection) {
  lacks_memory = true;
  ComeWithHello();
  ASSERT_TRUE(RunUntil(loop, [this] { return ended.size() == 1; }));
  EXPECT_EQ(metrics.Get(Counter::kAllocationsFailed), 1u);
  lacks_memory = false;
  ComeWithHello();
  EXPECT_NE(AwaitBegin(), nullptr);
}

// Nobody would look at the sockets any more.
TEST_F(HandshakeGateTest, LackOfMemoryForTheTimerEndsThoseThatWait) {
  HandshakeGate<PoorNet>::Parts parts;
  parts.metrics = &metrics;
  parts.places = &places;
  parts.begin = [this](tcp::socket, const std::string& host, HandshakeGate<PoorNet>::Place) {
    hosts.push_back(host);
  };
  parts.ended = [this](const std::string& host) { ended.push_back(host); };
  HandshakeGate<PoorNet> poor(loop, std::move(parts));
  tcp::socket& client = Come(&poor, "a", "");
  Come(&poor, "b", kHello.substr(0, 4));
  PoorNet::Timer::lacks_memory = true;
  const bool have_ended = RunUntil(loop, [this] { return ended.size() == 2; });
  PoorNet::Timer::lacks_memory = false;
  ASSERT_TRUE(have_ended);
  EXPECT_EQ(metrics.Get(Counter::kAllocationsFailed), 1u);
  asio::error_code error;
  char byte = 0;
  client.read_some(asio::buffer(&byte, 1), error);
  EXPECT_EQ(error, asio::error::eof);
  Come(&poor, "c", kHello);
  ASSERT_TRUE(RunUntil(loop, [this] { return !hosts.empty(); }));
  EXPECT_EQ(hosts, std::vector<std::string>{"c"});
}

}  // namespace
}  // namespace furrow::server
