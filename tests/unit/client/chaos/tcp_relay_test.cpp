// SPDX-License-Identifier: Apache-2.0
#include "client/chaos/tcp_relay.h"

#include <optional>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <sys/socket.h>

namespace furrow::chaos {
namespace {

// A connection through a relay. Data written at one end arrives at the other end at its scheduled
// time.
class TcpRelayTest : public testing::Test {
 protected:
  void Open(const Faults& up, const Faults& down = {}) {
    client_ = Pair(&inner_client_);
    server_ = Pair(&inner_server_);
    stream_.emplace(std::move(inner_client_), std::move(inner_server_), up, down, 0, 0);
  }
  static Descriptor Pair(Descriptor* inner) {
    int ends[2] = {-1, -1};
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends), 0);
    *inner = Descriptor(ends[1]);
    return Descriptor(ends[0]);
  }
  static void Write(const Descriptor& to, const std::string& text) {
    ASSERT_EQ(send(to.get(), text.data(), text.size(), 0), static_cast<ssize_t>(text.size()));
  }
  static std::string Read(const Descriptor& from) {
    std::string text(1 << 17, '\0');
    const ssize_t read = recv(from.get(), text.data(), text.size(), 0);
    text.resize(read > 0 ? static_cast<std::size_t>(read) : 0);
    return text;
  }
  // Pumps as a proxy without new data does: only when next_us() asks for it. Returns the number of
  // pumps.
  int PumpUntilIdle(std::int64_t from_us, std::int64_t to_us) {
    int pumps = 0;
    for (std::int64_t now = from_us; now >= 0 && now <= to_us; now = stream_->next_us(now)) {
      EXPECT_TRUE(stream_->Pump(now));
      ++pumps;
    }
    return pumps;
  }

  Descriptor client_, server_, inner_client_, inner_server_;
  std::optional<TcpRelay> stream_;
};

TEST_F(TcpRelayTest, WithoutFaultsItIsPumpedOnlyWhenDataArrives) {
  Open({});
  Write(client_, "there");
  Write(server_, "back");
  EXPECT_LE(PumpUntilIdle(0, 1'000'000), 3);
  EXPECT_EQ(Read(server_), "there");
  EXPECT_EQ(Read(client_), "back");
  EXPECT_EQ(stream_->next_us(5), -1);
  EXPECT_EQ(stream_->up_counts().bytes, 5u);
  EXPECT_EQ(stream_->down_counts().bytes, 4u);
  EXPECT_EQ(stream_->up_counts().held, 0u);
}

TEST_F(TcpRelayTest, DataLargerThanTheBufferIsForwarded) {
  Open({});
  const std::string large(100'000, 'x');
  Write(client_, large);
  PumpUntilIdle(0, 1'000'000);
  EXPECT_EQ(Read(server_), large);
}

TEST_F(TcpRelayTest, DataOfABlackHoleIsForwardedAfterIt) {
  Open({.black_holes = {{.start = 0.0, .length = 0.3}}});
  Write(client_, "late");
  EXPECT_TRUE(stream_->Pump(0));
  PumpUntilIdle(0, 299'000);
  EXPECT_EQ(Read(server_), "");
  PumpUntilIdle(299'500, 400'000);
  EXPECT_EQ(Read(server_), "late");
  EXPECT_NEAR(static_cast<double>(stream_->up_counts().still_us), 300'000.0, 2000.0);
  EXPECT_EQ(stream_->down_counts().still_us, 0);
}

TEST_F(TcpRelayTest, JitterHoldsBytesBackUntilTheyAreDue) {
  Open({.jitter_ms = 50.0});
  Write(client_, "x");
  EXPECT_TRUE(stream_->Pump(0));
  const std::int64_t due = stream_->next_us(0);
  EXPECT_GT(due, 0);
  EXPECT_LE(due, 50'000);
  PumpUntilIdle(due - 1, due - 1);
  EXPECT_EQ(Read(server_), "");
  PumpUntilIdle(due, due + 1'000'000);
  EXPECT_EQ(Read(server_), "x");
  EXPECT_EQ(stream_->up_counts().held, 1u);
}

TEST_F(TcpRelayTest, EndsWhenEitherSideCloses) {
  Open({});
  server_ = Descriptor();
  EXPECT_FALSE(stream_->Pump(0));
}

}  // namespace
}  // namespace furrow::chaos
