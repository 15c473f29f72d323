// SPDX-License-Identifier: Apache-2.0
#include "server/net/door/door.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include <asio/buffer.hpp>
#include <asio/co_spawn.hpp>
#include <asio/detached.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "server/net/asio_net.h"
#include "tests/log_capture.h"
#include "tests/unit/server/net/door/run_until.h"

namespace furrow::server {
namespace {

using asio::ip::tcp;
using testing::HasSubstr;

const char* const kHost = "127.0.0.1";

class DoorTest : public testing::Test {
 protected:
  // One host gets half of the places, rounded up.
  void Open(std::size_t places, int newcomers = Lobby::kPlaces) {
    door = MakeDoor(places, newcomers);
    const Status status = door->Open({kHost, 0});
    ASSERT_TRUE(status.ok()) << status.ToString();
    asio::co_spawn(loop, door->Accept(), asio::detached);
  }
  std::unique_ptr<Door<AsioNet>> MakeDoor(std::size_t places, int newcomers = Lobby::kPlaces) {
    Door<AsioNet>::Parts parts;
    parts.port = "test port";
    parts.limit = "test.limit";
    parts.flag = "--test";
    parts.listener = "test";
    parts.places = places;
    parts.newcomers = newcomers;
    parts.metrics = &metrics;
    parts.begin = [this](tcp::socket socket, const std::string& host) {
      if (lacks_memory) throw std::bad_alloc();
      begun.push_back(std::move(socket));
      hosts.push_back(host);
    };
    parts.refuse = [this](tcp::socket) { ++refused; };
    parts.make_room = [this](const std::string& host, bool any_host, Time, RoomRequest* request) {
      ++requests;
      wants_any_host = any_host;
      EXPECT_EQ(host, kHost);
      if (answer == Answer::kRefuse) request->Refuse();
      if (answer == Answer::kLater) refuse_later = request->RefuseLater();
    };
    return std::make_unique<Door<AsioNet>>(loop, std::move(parts));
  }
  tcp::socket Connect() {
    tcp::socket client(loop);
    client.connect({asio::ip::make_address(kHost), door->address().port});
    return client;
  }
  // One connection has the only place of the host, and another one waits for it.
  void OpenWithANewcomer(int newcomers = Lobby::kPlaces) {
    Open(2, newcomers);
    clients.push_back(Connect());
    ASSERT_TRUE(RunUntil(loop, [this] { return begun.size() == 1; }));
    clients.push_back(Connect());
    ASSERT_TRUE(RunUntil(loop, [this] { return requests > 0; }));
    EXPECT_FALSE(wants_any_host);
    EXPECT_EQ(begun.size(), 1u);
  }
  // The client sees that the daemon has closed its connection, without an answer.
  static bool IsClosed(tcp::socket& client) {
    char byte = 0;
    asio::error_code error;
    client.read_some(asio::buffer(&byte, 1), error);
    return error == asio::error::eof || error == asio::error::connection_reset;
  }

  enum class Answer : std::uint8_t { kWait, kRefuse, kLater };

  asio::io_context loop{1};
  Metrics metrics;
  Answer answer = Answer::kWait;
  bool lacks_memory = false;
  std::vector<tcp::socket> begun;
  std::vector<std::string> hosts;
  int refused = 0;
  int requests = 0;
  bool wants_any_host = false;
  std::shared_ptr<bool> refuse_later;
  std::vector<tcp::socket> clients;
  std::unique_ptr<Door<AsioNet>> door;  // destroyed first, as in a server
};

TEST_F(DoorTest, AConnectionHoldsAPlaceOfItsHost) {
  Open(4);
  const tcp::socket client = Connect();
  ASSERT_TRUE(RunUntil(loop, [this] { return !begun.empty(); }));
  EXPECT_EQ(hosts.front(), kHost);
  EXPECT_TRUE(door->TakePlace(kHost));
  EXPECT_FALSE(door->TakePlace(kHost)) << "the others are for other hosts";
  door->FreePlace(kHost);
  EXPECT_TRUE(door->TakePlace(kHost));
  door->SetPlaces(6);
  EXPECT_TRUE(door->TakePlace(kHost));
  EXPECT_EQ(requests, 0);
}

TEST_F(DoorTest, ANewcomerGetsThePlaceThatWasMade) {
  OpenWithANewcomer();
  door->FreePlace(kHost);
  ASSERT_TRUE(RunUntil(loop, [this] { return begun.size() == 2; }));
  EXPECT_FALSE(door->TakePlace(kHost)) << "the newcomer has it";
  EXPECT_EQ(refused, 0);
  EXPECT_EQ(metrics.Get(Counter::kConnectionsRefused), 0u);
}

// The lobby is full, and a place becomes free: it is not for one that comes later.
TEST_F(DoorTest, NobodyOvertakesTheQueue) {
  OpenWithANewcomer(/*newcomers=*/1);
  loop.poll();  // nothing is left of the newcomer but its timer
  clients.push_back(Connect());
  door->FreePlace(kHost);
  ASSERT_TRUE(RunUntil(loop, [this] { return begun.size() == 2; }));
  EXPECT_EQ(begun.back().remote_endpoint(), clients[1].local_endpoint());
  EXPECT_EQ(refused, 1);
  EXPECT_EQ(metrics.Get(Counter::kConnectionsRefused), 1u);
}

TEST_F(DoorTest, ANewcomerIsRefusedIfAllConnectionsAreInUse) {
  answer = Answer::kRefuse;
  OpenWithANewcomer();
  ASSERT_TRUE(RunUntil(loop, [this] { return refused == 1; }));
  EXPECT_EQ(requests, 1);
  EXPECT_EQ(begun.size(), 1u);
  EXPECT_EQ(metrics.Get(Counter::kConnectionsRefused), 1u);
}

TEST_F(DoorTest, TheRefusalMayComeLater) {
  answer = Answer::kLater;
  OpenWithANewcomer();
  EXPECT_EQ(refused, 0);
  *refuse_later = true;
  ASSERT_TRUE(RunUntil(loop, [this] { return refused == 1; }));
  EXPECT_EQ(metrics.Get(Counter::kConnectionsRefused), 1u);
}

TEST_F(DoorTest, AHostWithoutAPlaceMayTakeThatOfAnother) {
  Open(1);
  ASSERT_TRUE(door->TakePlace("192.0.2.1"));
  const tcp::socket client = Connect();
  ASSERT_TRUE(RunUntil(loop, [this] { return requests > 0; }));
  EXPECT_TRUE(wants_any_host);
  door->FreePlace("192.0.2.1");
  EXPECT_TRUE(RunUntil(loop, [this] { return begun.size() == 1; }));
}

TEST_F(DoorTest, LackOfMemoryCostsOneConnection) {
  Open(2);
  lacks_memory = true;
  tcp::socket client = Connect();
  ASSERT_TRUE(RunUntil(loop, [this] { return metrics.Get(Counter::kAllocationsFailed) == 1; }));
  EXPECT_TRUE(IsClosed(client));
  lacks_memory = false;
  const tcp::socket next = Connect();
  EXPECT_TRUE(RunUntil(loop, [this] { return begun.size() == 1; })) << "the place is free again";
}

TEST_F(DoorTest, WithoutDescriptorsItTriesAgain) {
  const LogCapture log;
  Open(2);
  const tcp::socket client = Connect();
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &limit), 0);
  const rlimit none{.rlim_cur = 0, .rlim_max = limit.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
  loop.poll();
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &limit), 0);
  EXPECT_TRUE(begun.empty());
  EXPECT_THAT(log.text(), HasSubstr("the test port accepts no connections: "));
  EXPECT_THAT(log.text(), HasSubstr("lower test.limit"));
  ASSERT_TRUE(RunUntil(loop, [this] { return begun.size() == 1; }));
  EXPECT_THAT(log.text(), HasSubstr("the test port accepts connections again"));
}

TEST_F(DoorTest, ItLeavesNewcomersToTheNextDaemon) {
  OpenWithANewcomer();
  door->Leave();
  clients.push_back(Connect());
  door->FreePlace(kHost);
  ASSERT_TRUE(RunUntil(loop, [this] { return begun.size() == 2; })) << "it was accepted before";
  door->FreePlace(kHost);
  loop.restart();
  loop.poll();
  EXPECT_EQ(begun.size(), 2u) << "the listening socket keeps the third";
  tcp::acceptor next(loop);
  next.assign(tcp::v4(), dup(door->socket()));
  EXPECT_TRUE(next.accept().is_open());
}

TEST_F(DoorTest, AcceptedNewcomersComeInAfterTheEndOfListening) {
  OpenWithANewcomer();
  door->StopListening();
  EXPECT_FALSE(door->is_closed());
  EXPECT_THROW(Connect(), asio::system_error);
  door->FreePlace(kHost);
  EXPECT_TRUE(RunUntil(loop, [this] { return begun.size() == 2; }));
}

TEST_F(DoorTest, AClosedDoorLetsNobodyIn) {
  OpenWithANewcomer();
  door->Close();
  EXPECT_TRUE(door->is_closed());
  EXPECT_THROW(Connect(), asio::system_error);
  door->FreePlace(kHost);
  loop.restart();
  loop.run();  // until the newcomer has gone, and nothing else is left
  EXPECT_TRUE(IsClosed(clients.back()));
  EXPECT_EQ(begun.size(), 1u);
  EXPECT_EQ(refused, 0);
}

// As at the end of a daemon: the loop destroys what still waits, after the door.
TEST_F(DoorTest, CoroutinesMayOutliveTheDoor) {
  answer = Answer::kLater;
  OpenWithANewcomer();
  door.reset();
  *refuse_later = true;
}

TEST_F(DoorTest, APortThatIsTakenIsAnErrorAndAnotherOneMayFollow) {
  Open(2);
  const auto second = MakeDoor(2);
  const std::uint16_t port = door->address().port;
  const Status status = second->Open({kHost, port});
  EXPECT_EQ(status.code(), StatusCode::kUnavailable);
  EXPECT_THAT(status.what(),
              HasSubstr("cannot listen on TCP 127.0.0.1 port " + std::to_string(port)));
  EXPECT_THAT(status.todo(), HasSubstr("--test"));
  ASSERT_TRUE(second->Open({kHost, 0}).ok());
  EXPECT_EQ(second->address().host, kHost);
  EXPECT_NE(second->address().port, port);
}

TEST_F(DoorTest, ItListensAtASocketOfTheServiceManager) {
  tcp::acceptor passed(loop, tcp::endpoint(asio::ip::make_address(kHost), 0));
  const std::uint16_t port = passed.local_endpoint().port();
  door = MakeDoor(2);
  ASSERT_TRUE(door->Adopt({passed.release(), /*is_v6=*/false, kHost}).ok());
  EXPECT_EQ(door->address(), (HostPort{kHost, port}));
  asio::co_spawn(loop, door->Accept(), asio::detached);
  const tcp::socket client = Connect();
  EXPECT_TRUE(RunUntil(loop, [this] { return begun.size() == 1; }));
}

TEST_F(DoorTest, ASocketThatCannotBeUsedIsNamed) {
  door = MakeDoor(2);
  const Status status = door->Adopt({-1, /*is_v6=*/false, kHost});
  EXPECT_EQ(status.code(), StatusCode::kUnavailable);
  EXPECT_THAT(status.what(), HasSubstr("cannot use the socket 'test' of the service manager: "));
}

}  // namespace
}  // namespace furrow::server
