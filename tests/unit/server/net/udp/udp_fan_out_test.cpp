// SPDX-License-Identifier: Apache-2.0
// Many subjects and many subscribers over real sockets: every frame arrives, in fewer datagrams.
#include <memory>
#include <string>
#include <vector>

#include <asio/io_context.hpp>
#include <gtest/gtest.h>

#include "client/cpp/subscriber.h"
#include "protocol/framing/bundle.h"
#include "server/net/clock.h"
#include "server/net/udp/udp_server.h"
#include "tests/unit/server/net/udp/proven_hello.h"
#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

using asio::ip::udp;
using client::Event;
using client::IoStatus;

constexpr int kSubjects = 24;
constexpr int kSubscribers = 64;
constexpr int kRounds = 4;

// A client that either splits bundles or, like old clients, does not.
class Wire : public client::Transport {
 public:
  Wire(std::uint16_t port, bool takes_bundles)
      : Transport(client::TransportKind::kUdp), takes_bundles_(takes_bundles) {
    socket_.connect({asio::ip::address_v4::loopback(), port});
    socket_.non_blocking(true);
  }
  IoStatus Send(std::span<const std::uint8_t> message) override {
    socket_.send(asio::buffer(message.data(), message.size()));
    return IoStatus::kOk;
  }
  IoStatus Receive(std::span<const std::uint8_t>& message, std::chrono::milliseconds) override {
    while (!unbundler_.Next(message)) {
      asio::error_code error;
      const std::size_t size = socket_.receive(asio::buffer(buffer_), 0, error);
      if (error) return IoStatus::kTimeout;
      ++datagrams;
      const auto datagram = std::span(buffer_).first(size);
      if (takes_bundles_) {
        EXPECT_EQ(unbundler_.Open(datagram), protocol::BundleStatus::kOk);
      } else {
        message = datagram;
        return IoStatus::kOk;
      }
    }
    return IoStatus::kOk;
  }
  [[nodiscard]] bool takes_bundles() const override { return takes_bundles_; }

  int datagrams = 0;

 private:
  bool takes_bundles_;
  asio::io_context io_;
  udp::socket socket_{io_, udp::v4()};
  std::vector<std::uint8_t> buffer_ = std::vector<std::uint8_t>(4096);
  protocol::Unbundler unbundler_;
};

// A client that subscribes to every subject.
struct Watcher {
  Wire* wire = nullptr;
  std::unique_ptr<client::Subscriber> subscriber;
  std::vector<int> subjects;  // by subscription
  std::vector<int> rounds;    // weight frames so far, by subject
  int decayed = 0;            // weight frames without a new pose
  int others = 0;             // messages other than weights
};

class UdpFanOutTest : public HubTest {
 protected:
  void SetUp() override {
    MakeWith(MakeRig(/*filter=*/false));
    server = std::make_unique<UdpServer>(io, Limits(), hub.get(), &metrics);
    ASSERT_TRUE(server->Open({asio::ip::address_v4::loopback(), 0}).ok());
    server->Start();
    publisher.send_to(asio::buffer(ProvenHello(*hub, publisher)),
                      {asio::ip::address_v4::loopback(), server->port()});
    for (std::uint16_t i = 0; i < kSubjects; ++i) Say(Offer(NameOf(i)), {.stream = i});
    Work();
  }
  void TearDown() override {
    server->Close();
    io.run();
  }

  static std::string NameOf(int subject) { return "subject " + std::to_string(subject); }
  static float BrowOf(int subject, int round) {
    return static_cast<float>(subject * kRounds + round) / (kSubjects * kRounds);
  }
  void Work() {
    io.restart();
    io.poll();
  }
  template <class Message>
  void Say(const Message& message, protocol::Header header) {
    header.session = 77;
    encoder.Encode(header, message, bytes);
    publisher.send_to(asio::buffer(bytes), {asio::ip::address_v4::loopback(), server->port()});
  }
  // Sends a pose of every subject; the server reads all of them at once.
  void Play(int round) {
    for (int i = 0; i < kSubjects; ++i) {
      Say(Pose(BrowOf(i, round)), {.stream = static_cast<std::uint16_t>(i),
                                   .sequence = static_cast<std::uint32_t>(round),
                                   .capture_time_us = 16'667 * round});
    }
    Work();
  }
  // Proves its address and subscribes to every subject.
  Watcher Join(bool takes_bundles) {
    Watcher watcher;
    auto wire = std::make_unique<Wire>(server->port(), takes_bundles);
    watcher.wire = wire.get();
    watcher.subscriber = std::make_unique<client::Subscriber>(std::move(wire), "test");
    for (int i = 0; i < kSubjects; ++i) {
      (void)watcher.subscriber->Subscribe(protocol::SubscribeWeights{.subject = NameOf(i)});
    }
    watcher.subjects.resize(kSubjects + 1, -1);
    watcher.rounds.resize(kSubjects, 0);
    for (int step = 0; step < 4; ++step) {
      Work();
      Read(watcher);
    }
    EXPECT_EQ(watcher.others, kSubjects) << "answers";
    return watcher;
  }
  // Reads and checks the received messages.
  static void Read(Watcher& watcher) {
    for (;;) {
      const Event event = watcher.subscriber->Next(0, std::chrono::milliseconds(0));
      if (event.kind == Event::Kind::kTimeout) return;
      ASSERT_LT(event.header.stream, watcher.subjects.size());
      int& subject = watcher.subjects[event.header.stream];
      if (event.kind != Event::Kind::kWeights) {
        ASSERT_EQ(event.kind, Event::Kind::kReply);
        subject = static_cast<int>(event.header.sequence) - 1;
        ++watcher.others;
        continue;
      }
      ASSERT_GE(subject, 0);
      if (watcher.subscriber->weights().age_us > 0) {
        ++watcher.decayed;
        continue;
      }
      const auto round = static_cast<int>(event.header.sequence);
      EXPECT_EQ(round, watcher.rounds[static_cast<std::size_t>(subject)]++) << "lost or reordered";
      EXPECT_FLOAT_EQ(watcher.subscriber->weights().values[0], BrowOf(subject, round));
    }
  }

  asio::io_context io{1};
  std::unique_ptr<UdpServer> server;
  udp::socket publisher{io, udp::v4()};
  std::vector<std::uint8_t> bytes;
};

TEST_F(UdpFanOutTest, WeightsArriveInFewerDatagramsAndBundlesOnlyWhereAccepted) {
  std::vector<Watcher> watchers;
  for (int i = 0; i < kSubscribers; ++i) watchers.push_back(Join(/*takes_bundles=*/i > 0));
  Watcher& old = watchers.front();
  for (Watcher& watcher : watchers) watcher.wire->datagrams = 0;
  const std::uint64_t sent_before = Count(Counter::kDatagramsSent);
  for (int round = 0; round < kRounds; ++round) {
    Play(round);
    for (Watcher& watcher : watchers) Read(watcher);
  }
  std::uint64_t datagrams = 0;
  for (Watcher& watcher : watchers) {
    EXPECT_EQ(watcher.rounds, std::vector<int>(kSubjects, kRounds));
    EXPECT_EQ(watcher.subscriber->malformed(), 0u);
    EXPECT_EQ(watcher.others, kSubjects);
    datagrams += static_cast<std::uint64_t>(watcher.wire->datagrams);
    if (&watcher != &old) {
      EXPECT_LE(watcher.wire->datagrams, kSubjects * kRounds / 6);
    }
  }
  EXPECT_EQ(old.wire->datagrams, kSubjects * kRounds);
  EXPECT_EQ(Count(Counter::kWeightsSent), std::uint64_t{kSubscribers * kSubjects * kRounds});
  EXPECT_EQ(Count(Counter::kDatagramsSent) - sent_before, datagrams);
  EXPECT_EQ(Count(Counter::kDatagramsUnsendable), 0u);
  EXPECT_GE(Count(Counter::kMessagesBundled),
            std::uint64_t{(kSubscribers - 1) * kSubjects * kRounds});
}

TEST_F(UdpFanOutTest, FramesOfATickShareDatagrams) {
  Watcher watcher = Join(/*takes_bundles=*/true);
  Play(0);
  Play(1);  // every weight is above 0
  Read(watcher);
  watcher.wire->datagrams = 0;
  hub->Tick(ReadClock() + FromSeconds(1.5));
  Read(watcher);
  EXPECT_EQ(watcher.rounds, std::vector<int>(kSubjects, 2));
  EXPECT_EQ(watcher.decayed, kSubjects);
  EXPECT_LE(watcher.wire->datagrams, kSubjects / 6);
}

}  // namespace
}  // namespace furrow::server
