// SPDX-License-Identifier: Apache-2.0
#include "server/restart/shutdown.h"

#include <cstdint>
#include <memory>
#include <utility>

#include <asio/io_context.hpp>
#include <asio/post.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/net/clock.h"
#include "tests/unit/server/session/fake_cluster.h"
#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

using ::testing::StartsWith;

// The daemon serves "ada", who cannot move because her lease has not been renewed.
class ShutdownTest : public HubPeersTest {
 protected:
  ShutdownTest() { cluster = &nodes; }
  void SetUp() override {
    Make({}, /*filter=*/false);
    Connect(&sender);
    nodes.places["ada"] = FakeCluster::Here(now + FromSeconds(1.0), 1);
    Publish(sender, "ada");
    Shutdown::Parts parts;
    parts.io = &io;
    parts.hub = hub.get();
    parts.mover = std::make_unique<Mover>(io, &gate, hub.get(), [] { return std::uint64_t{1}; });
    parts.drain_time = [] { return FromSeconds(60.0); };
    parts.on_begin = [] {};
    parts.stop = [this] { ++stops; };
    parts.is_sending = [] { return false; };
    parts.close = [] {};
    shutdown = std::make_unique<Shutdown>(std::move(parts));
  }

  FakeCluster nodes;
  Metrics gate_metrics;
  TokenGate gate{{}, [] { return std::uint64_t{0}; }, &gate_metrics};
  asio::io_context io;
  std::unique_ptr<Shutdown> shutdown;
  int stops = 0;
};

// SIGTERM may come before the first step of the drain.
TEST_F(ShutdownTest, MovesTheSubjectsAlthoughADrainWasRequestedAMomentAgo) {
  EXPECT_TRUE(shutdown->OnDrainRequest(/*begin=*/true).draining);
  shutdown->Request();
  io.run();
  EXPECT_EQ(stops, 1);
  EXPECT_THAT(shutdown->OnDrainRequest(/*begin=*/false).why, StartsWith("'ada': "));
}

TEST_F(ShutdownTest, MovesTheSubjectsOfADaemonThatNobodyDrains) {
  EXPECT_FALSE(shutdown->OnDrainRequest(/*begin=*/false).draining);
  shutdown->Request();
  shutdown->Request();
  io.run();
  EXPECT_EQ(stops, 1);
  EXPECT_THAT(shutdown->OnDrainRequest(/*begin=*/false).why, StartsWith("'ada': "));
}

// A daemon that restarts, and a client that must connect again and reads slowly.
class LeavingTest : public HubPeersTest {
 protected:
  void SetUp() override { Make({}, /*filter=*/false); }

  // Returns whether all messages left before the end.
  bool Run(bool saves, bool owes_frames, Time sends_for) {
    Shutdown::Parts parts;
    parts.io = &io;
    parts.hub = hub.get();
    parts.drain_time = [] { return FromSeconds(60.0); };
    parts.on_begin = [] {};
    parts.let_go = [this] {
      EXPECT_EQ(calls, 0) << "the daemon serves meanwhile";
      ++lets_go;
      return lets_go == lets_go_at;
    };
    parts.leave = [this] { return ++calls == 3; };
    parts.save = [this, saves] {
      EXPECT_EQ(calls, 3);
      EXPECT_TRUE(passed) << "what other threads have posted comes before";
      return saves;
    };
    parts.owes_frames = [owes_frames] { return owes_frames; };
    parts.stop = [&] { sent = ReadClock() + sends_for; };
    bool all = false;
    parts.is_sending = [&] {
      all = ReadClock() >= sent;
      return !all;
    };
    parts.close = [] {};
    Shutdown shutdown(std::move(parts));
    shutdown.Request();
    asio::post(io, [this] { passed = true; });
    io.run();
    return all;
  }

  asio::io_context io;
  int lets_go = 0;
  int lets_go_at = 3;
  int calls = 0;
  bool passed = false;
  Time sent{0};
};

TEST_F(LeavingTest, TheNextDaemonDoesNotWaitForSlowReaders) {
  EXPECT_FALSE(Run(/*saves=*/true, /*owes_frames=*/false, FromSeconds(30.0)));
}

TEST_F(LeavingTest, MemoryIsFreedBeforeTheDaemonLeaves) {
  (void)Run(/*saves=*/true, /*owes_frames=*/false, FromSeconds(0.0));
  EXPECT_EQ(lets_go, lets_go_at);
}

TEST_F(LeavingTest, LeavesWithoutWaitingForeverForMemory) {
  lets_go_at = -1;
  EXPECT_TRUE(Run(/*saves=*/true, /*owes_frames=*/false, FromSeconds(0.0)));
  EXPECT_EQ(calls, 3);
}

TEST_F(LeavingTest, FramesThatMayNotBeLeftOutHaveTheirTime) {
  EXPECT_TRUE(Run(/*saves=*/true, /*owes_frames=*/true, FromSeconds(0.3)));
}

TEST_F(LeavingTest, WhoeverCannotLeaveHasItsTime) {
  EXPECT_TRUE(Run(/*saves=*/false, /*owes_frames=*/false, FromSeconds(0.3)));
}

}  // namespace
}  // namespace furrow::server
