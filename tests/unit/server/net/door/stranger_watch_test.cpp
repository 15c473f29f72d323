// SPDX-License-Identifier: Apache-2.0
#include "server/net/door/stranger_watch.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <new>
#include <utility>

#include <gtest/gtest.h>

#include "server/core/metrics.h"
#include "server/tls/handshake.h"
#include "server/tls/handshake_places.h"
#include "server/tls/stranger_patience.h"

namespace furrow::server {
namespace {

// A loop with one timer, which the test lets expire.
struct FakeLoop {
  std::function<void(bool cancelled)> handler;
  bool lacks_memory = false;
};

struct FakeTimer {
  explicit FakeTimer(FakeLoop* its_loop) : loop(its_loop) {}
  void expires_after(std::chrono::milliseconds) {}
  void async_wait(std::function<void(bool)> handler) {
    if (loop->lacks_memory) throw std::bad_alloc();
    loop->handler = std::move(handler);
  }
  void cancel() {}  // as if the call were queued already
  FakeLoop* loop;
};

struct FakeSocket {
  [[nodiscard]] FakeLoop* get_executor() { return &loop; }
  [[nodiscard]] bool is_open() const { return open; }
  [[nodiscard]] int native_handle() const { return -1; }
  void close(bool&) { open = false; }
  FakeLoop loop;
  bool open = true;
};

class StrangerWatchTest : public testing::Test {
 protected:
  ~StrangerWatchTest() override { socket.loop.handler = nullptr; }  // it holds the watch
  void Tick() {
    auto handler = std::exchange(socket.loop.handler, nullptr);
    ASSERT_TRUE(handler) << "nobody watches";
    handler(/*cancelled=*/false);
  }
  // Lets time pass as the watch looks.
  void Pass(Time time) {
    for (const Time end = now + time; now < end && socket.open;) {
      now = std::min<Time>(now + std::chrono::milliseconds(50), end);
      Tick();
    }
  }

  FakeSocket socket;
  HandshakePlaces places;
  Metrics metrics;
  Time now = std::chrono::seconds(100);
  std::unique_ptr<StrangerWatch<FakeTimer, FakeSocket>> watch =
      std::make_unique<StrangerWatch<FakeTimer, FakeSocket>>(socket, places.Enter("a"), &metrics,
                                                             [this] { return now; });
};

TEST_F(StrangerWatchTest, AHandshakeHasItsTime) {
  Pass(kHandshakeDeadline - Time(1));
  EXPECT_TRUE(socket.open);
  Pass(Time(1));
  EXPECT_FALSE(socket.open);
  EXPECT_TRUE(watch->expired());
  EXPECT_EQ(metrics.Get(Counter::kConnectionsGaveWay), 0u);
}

TEST_F(StrangerWatchTest, AStrangerStaysWhileNobodyWaits) {
  watch->EndHandshake();
  Pass(std::chrono::minutes(1));
  EXPECT_TRUE(socket.open);
  EXPECT_FALSE(watch->IsWanted());
  const auto waiting = places.Wait("a");
  EXPECT_TRUE(watch->IsWanted());
  Pass(StrangerPatience::kSilence - Time(1));
  EXPECT_TRUE(socket.open) << "it has all its time from when others wait";
  Pass(Time(1));
  EXPECT_FALSE(socket.open);
  EXPECT_TRUE(watch->expired());
  EXPECT_EQ(metrics.Get(Counter::kConnectionsGaveWay), 1u);
}

TEST_F(StrangerWatchTest, ARequestIsAStep) {
  const auto waiting = places.Wait("a");
  Pass(StrangerPatience::kSilence - Time(1));
  watch->EndHandshake();
  Pass(StrangerPatience::kSilence - Time(1));
  watch->NoteRequest();
  Pass(StrangerPatience::kSilence - Time(1));
  EXPECT_TRUE(socket.open);
  Pass(Time(1));
  EXPECT_FALSE(socket.open);
}

// Nobody would end the stranger if the timer could not be set again.
TEST_F(StrangerWatchTest, LackOfMemoryClosesTheSocket) {
  Pass(std::chrono::milliseconds(50));
  EXPECT_TRUE(socket.open);
  socket.loop.lacks_memory = true;
  Pass(std::chrono::milliseconds(50));
  EXPECT_FALSE(socket.open);
  EXPECT_TRUE(watch->expired());
  EXPECT_EQ(metrics.Get(Counter::kAllocationsFailed), 1u);
}

TEST_F(StrangerWatchTest, ACallAfterItsEndDoesNothing) {
  watch.reset();
  EXPECT_NE(places.Enter("a"), nullptr) << "the place is free";
  now += std::chrono::minutes(1);
  Tick();
  EXPECT_TRUE(socket.open);
}

}  // namespace
}  // namespace furrow::server
