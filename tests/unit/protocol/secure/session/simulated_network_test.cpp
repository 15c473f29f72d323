// SPDX-License-Identifier: Apache-2.0
// Client and server over a simulated network in simulated time: loss, reordering, duplicates, a
// server that restarts, an address that changes, an attacker who injects.
#include <functional>
#include <map>
#include <memory>

#include <gtest/gtest.h>

#include "tests/unit/protocol/secure/session/session_testing.h"

namespace furrow::protocol::secure {
namespace {

using test::Bytes;
using test::kAway;
using test::kHome;
using test::Text;

struct NetworkSettings {
  double loss = 0.0;
  double duplicates = 0.0;
  std::int64_t delay_us = 5'000;
  std::int64_t jitter_us = 0;
};

// One client that sends a pose every 16 ms, and one server that answers each with weights.
class Simulation {
 public:
  Simulation(NetworkSettings settings, std::uint64_t seed)
      : settings_(settings),
        random_(seed),
        ring_(test::MakeRing(random_)),
        token_(test::MakeTestToken(ring_, random_)),
        client_(std::make_unique<SecureClient>(token_, Text("hello"), random_)) {
    StartServer();
  }

  void StartServer() {
    server_ = std::make_unique<SecureServer>(SecureServerSettings{}, random_);
    server_->SetKeys(ring_);
    session_ = 0;
  }
  void StopServer() { server_.reset(); }
  void StartClient() { client_ = std::make_unique<SecureClient>(token_, Text("hello"), random_); }
  void Move(const PeerAddress& address) { address_ = address; }
  void set_settings(NetworkSettings settings) { settings_ = settings; }
  // Called with everything that crosses the network; may send more with Inject().
  void set_attacker(std::function<void(const Bytes&, bool to_server)> attacker) {
    attacker_ = std::move(attacker);
  }
  void Inject(Bytes datagram, bool to_server, const PeerAddress& from) {
    Put({std::move(datagram), from, to_server});
  }

  // Runs for some time. Returns the number of weights that the client received.
  int Run(std::int64_t duration_us) {
    const int before = weights_;
    const std::int64_t end = now_us_ + duration_us;
    for (; now_us_ < end; now_us_ += 1'000) {
      Deliver();
      PollClient();
      if (now_us_ % 16'000 == 0) SendPose();
      if (server_ && now_us_ % 1'000'000 == 0) server_->Expire(now());
    }
    return weights_ - before;
  }
  // Runs until the client receives weights. Returns the time that took, at most `limit_us`.
  std::int64_t RunUntilWeights(std::int64_t limit_us) {
    const std::int64_t begin = now_us_;
    while (now_us_ - begin < limit_us && Run(1'000) == 0) {
    }
    return now_us_ - begin;
  }

  [[nodiscard]] Now now() const {
    return {now_us_, test::kUnixNow + static_cast<std::uint64_t>(now_us_ / 1'000'000)};
  }
  [[nodiscard]] SecureServer& server() { return *server_; }
  [[nodiscard]] const PeerAddress& address() const { return address_; }
  [[nodiscard]] int connections() const { return connections_; }
  [[nodiscard]] int wrong() const { return wrong_; }

 private:
  struct Datagram {
    Bytes bytes;
    PeerAddress from;
    bool to_server = false;
  };

  [[nodiscard]] bool Chance(double probability) {
    return static_cast<double>(random_.Below(1'000'000)) < probability * 1e6;
  }
  void Put(Datagram datagram) {
    const auto jitter = static_cast<std::uint64_t>(settings_.jitter_us) + 1;
    const std::int64_t at =
        now_us_ + settings_.delay_us + static_cast<std::int64_t>(random_.Below(jitter));
    network_.emplace(at, std::move(datagram));
  }
  void Send(const Bytes& bytes, bool to_server) {
    if (attacker_) attacker_(bytes, to_server);
    const Datagram datagram{bytes, address_, to_server};
    if (!Chance(settings_.loss)) Put(datagram);
    if (Chance(settings_.duplicates)) Put(datagram);
  }
  void Deliver() {
    while (!network_.empty() && network_.begin()->first <= now_us_) {
      Datagram datagram = std::move(network_.begin()->second);
      network_.erase(network_.begin());
      if (datagram.to_server) {
        AtServer(datagram);
      } else {
        AtClient(datagram);
      }
    }
  }
  void AtServer(Datagram& datagram) {
    if (!server_) return;
    const ServerEvent event = server_->OnDatagram(datagram.bytes, datagram.from, now());
    // To the sender; whoever is not at the client's address does not reach the client.
    if (event.reply_size > 0 && datagram.from == address_) {
      Send({event.reply().begin(), event.reply().end()}, false);
    }
    if (event.opened) {
      session_ = event.session;
      if (event.hello != Text("hello")) ++wrong_;
    }
    if (event.inner.empty()) return;
    if (Bytes(event.inner.begin(), event.inner.end()) != Text("pose")) ++wrong_;
    Bytes weights = test::Packet(Text("weights"));
    PeerAddress to;
    if (server_->Seal(event.session, weights, now(), to) == SealStatus::kOk && to == address_) {
      Send(weights, false);
    }
  }
  void AtClient(Datagram& datagram) {
    const ClientEvent event = client_->OnDatagram(datagram.bytes, now());
    if (event.connected) ++connections_;
    if (event.inner.empty()) return;
    if (Bytes(event.inner.begin(), event.inner.end()) != Text("weights")) ++wrong_;
    ++weights_;
  }
  void PollClient() {
    Bytes packet(kMaxPacketBytes);
    while (const std::size_t size = client_->Poll(now(), packet)) {
      Send({packet.begin(), packet.begin() + static_cast<std::ptrdiff_t>(size)}, true);
    }
  }
  void SendPose() {
    Bytes packet = test::Packet(Text("pose"));
    if (client_->Seal(packet, now()) == SealStatus::kOk) Send(packet, true);
  }

  NetworkSettings settings_;
  test::RepeatableRandom random_;
  KeyRing ring_;
  ClientToken token_;
  std::unique_ptr<SecureServer> server_;
  std::unique_ptr<SecureClient> client_;
  std::function<void(const Bytes&, bool)> attacker_;
  std::multimap<std::int64_t, Datagram> network_;
  PeerAddress address_ = kHome;
  std::uint32_t session_ = 0;
  std::int64_t now_us_ = 0;
  int weights_ = 0;
  int connections_ = 0;
  int wrong_ = 0;
};

constexpr NetworkSettings kGood;
constexpr NetworkSettings kBad = {0.1, 0.05, 5'000, 50'000};
constexpr NetworkSettings kTerrible = {0.4, 0.2, 20'000, 150'000};

TEST(SimulatedNetwork, ConnectsInThreeRoundTripsAndStays) {
  Simulation s(kGood, 1);
  EXPECT_LE(s.RunUntilWeights(1'000'000), 60'000);
  EXPECT_GE(s.Run(10'000'000), 620);
  EXPECT_EQ(s.connections(), 1);
  EXPECT_EQ(s.wrong(), 0);
}

TEST(SimulatedNetwork, LossReorderingAndDuplicatesCostNoSession) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Simulation s(kBad, seed);
    EXPECT_LE(s.RunUntilWeights(5'000'000), 2'500'000) << seed;
    // Of 625 poses, 81% and their answers survive, and duplicates are dropped.
    const int weights = s.Run(10'000'000);
    EXPECT_GE(weights, 460) << seed;
    EXPECT_LE(weights, 625 + 10) << seed;
    EXPECT_EQ(s.connections(), 1) << seed;
    EXPECT_EQ(s.wrong(), 0);
  }
}

TEST(SimulatedNetwork, RecoversFromATerribleNetwork) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Simulation s(kTerrible, seed);
    (void)s.Run(20'000'000);
    s.set_settings(kGood);
    EXPECT_LE(s.RunUntilWeights(5'000'000), 1'000'000) << seed;
    EXPECT_GE(s.Run(1'000'000), 60) << seed;
    EXPECT_EQ(s.wrong(), 0);
  }
}

// kill -9 under load: weights again within a second of the server's return.
TEST(SimulatedNetwork, RecoversWithinASecondOfARestart) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Simulation s(kGood, seed);
    (void)s.Run(1'000'000);
    s.StopServer();
    (void)s.Run(static_cast<std::int64_t>(seed) * 370'000);
    s.StartServer();
    EXPECT_LE(s.RunUntilWeights(5'000'000), 1'000'000) << seed;
    EXPECT_EQ(s.connections(), 2) << seed;
    EXPECT_EQ(s.server().num_sessions(), 1u);
  }
}

TEST(SimulatedNetwork, RecoversFromARestartOnABadNetwork) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Simulation s(kBad, seed);
    (void)s.Run(3'000'000);
    s.StartServer();
    EXPECT_LE(s.RunUntilWeights(10'000'000), 3'000'000) << seed;
    EXPECT_GE(s.Run(2'000'000), 60) << seed;
  }
}

TEST(SimulatedNetwork, AClientThatStartsAgainGetsIn) {
  Simulation s(kGood, 3);
  (void)s.Run(1'000'000);
  s.StartClient();
  EXPECT_LE(s.RunUntilWeights(5'000'000), 100'000);
  EXPECT_EQ(s.server().num_sessions(), 1u);
}

TEST(SimulatedNetwork, ANewAddressKeepsTheSession) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Simulation s(seed % 2 == 0 ? kGood : kBad, seed);
    (void)s.Run(5'000'000);
    const int connections = s.connections();
    s.Move(kAway);
    (void)s.Run(100'000);  // what was on the way
    // The client probes after half a second of silence. If that is lost too often, it connects
    // again.
    EXPECT_LE(s.RunUntilWeights(10'000'000), seed % 2 == 0 ? 500'000 : 2'500'000) << seed;
    EXPECT_GE(s.Run(1'000'000), 40) << seed;
    if (seed % 2 == 0) {
      EXPECT_EQ(s.connections(), connections) << seed;
    }
    EXPECT_EQ(s.wrong(), 0);
  }
}

TEST(SimulatedNetwork, SurvivesMinutesWithoutANetwork) {
  Simulation s(kGood, 4);
  (void)s.Run(1'000'000);
  s.set_settings({1.0, 0.0, 5'000, 0});
  (void)s.Run(100'000);  // what was on the way
  EXPECT_EQ(s.Run(150'000'000), 0);
  EXPECT_EQ(s.server().num_sessions(), 0u);
  s.set_settings(kGood);
  EXPECT_LE(s.RunUntilWeights(5'000'000), 1'000'000);
}

// Copies, changed copies and forged hints from another address, at three times the rate of the
// client.
TEST(SimulatedNetwork, AnAttackerBesideTheNetworkChangesNothing) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Simulation s(kGood, seed);
    test::RepeatableRandom random(seed);
    s.set_attacker([&](const Bytes& bytes, bool to_server) {
      s.Inject(bytes, to_server, kAway);
      Bytes changed = bytes;
      changed[random.Below(changed.size())] ^= static_cast<std::uint8_t>(1 + random.Below(255));
      s.Inject(changed, to_server, s.address());
      Bytes reset(kRefusedBytes);
      std::copy_n(bytes.begin(), std::min<std::size_t>(8, bytes.size()), reset.begin());
      reset[0] = static_cast<std::uint8_t>(PacketKind::kRefused);
      reset[8] = static_cast<std::uint8_t>(1 + random.Below(9));
      s.Inject(reset, false, kAway);
      // A retry with a useless cookie for whatever index is on the network.
      Bytes retry(kRetryBytes);
      std::copy_n(bytes.begin(), std::min<std::size_t>(8, bytes.size()), retry.begin());
      retry[0] = static_cast<std::uint8_t>(PacketKind::kRetry);
      if (random.Below(4) == 0) s.Inject(retry, false, kAway);
    });
    EXPECT_LE(s.RunUntilWeights(5'000'000), 2'000'000) << seed;
    EXPECT_GE(s.Run(10'000'000), 560) << seed;
    EXPECT_EQ(s.wrong(), 0);
    EXPECT_LE(s.server().num_sessions(), 1 + SecureServer::kMaxUnconfirmedOfAToken);
  }
}

}  // namespace
}  // namespace furrow::protocol::secure
