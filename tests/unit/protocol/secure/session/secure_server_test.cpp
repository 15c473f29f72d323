// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/session/secure_server.h"

#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/allocation_counter.h"
#include "tests/unit/protocol/secure/session/session_testing.h"

namespace furrow::protocol::secure {
namespace {

using test::Bytes;
using test::kAway;
using test::kHome;
using test::kSameHost;
using test::Meeting;
using test::Text;

TEST(SecureServer, OpensASessionWithTheFirstPacketOfTheClient) {
  Meeting m;
  Bytes packet = m.Poll();
  EXPECT_EQ(packet.size(), 1'200u);
  ServerEvent event = m.ToServer(packet);
  EXPECT_EQ(event.reply_size, kRetryBytes);
  (void)m.ToClient(event.reply());
  event = m.ToServer(m.Poll());
  EXPECT_EQ(event.reply_size, 60u);
  EXPECT_FALSE(event.opened);
  EXPECT_TRUE(m.ToClient(event.reply()).connected);
  event = m.ToServer(m.FromClient("pose"));
  ASSERT_TRUE(event.opened);
  EXPECT_EQ(event.hello, Text("hello"));
  EXPECT_EQ(Bytes(event.inner.begin(), event.inner.end()), Text("pose"));
  EXPECT_EQ(m.server.InfoOf(event.session).grant->subjects, "stage-*");
  EXPECT_EQ(*m.server.AddressOf(event.session), kHome);
  // The hello opens a session once.
  EXPECT_TRUE(m.ToServer(m.FromClient("pose")).hello.empty());

  Bytes reply = test::Packet(Text("weights"));
  PeerAddress to;
  ASSERT_EQ(m.server.Seal(event.session, reply, m.now, to), SealStatus::kOk);
  EXPECT_EQ(to, kHome);
  const ClientEvent received = m.ToClient(reply);
  EXPECT_EQ(Bytes(received.inner.begin(), received.inner.end()), Text("weights"));
}

// A recorded handshake does not open a session: it lacks the first packet.
TEST(SecureServer, SendsNothingToASessionThatIsNotOpen) {
  Meeting m;
  (void)m.ToClient(m.ToServer(m.Poll()).reply());
  (void)m.ToServer(m.Poll());
  EXPECT_EQ(m.server.num_sessions(), 1u);
  Bytes packet = test::Packet(Text("weights"));
  PeerAddress to;
  for (std::uint32_t high = 0; high < 0x10000; ++high) {
    ASSERT_EQ(m.server.Seal(high << 16, packet, m.now, to), SealStatus::kNotConnected);
  }
  m.server.Expire(test::Later(m.now, SecureServer::kUnconfirmedMicroseconds));
  EXPECT_EQ(m.server.num_sessions(), 0u);
  EXPECT_TRUE(m.server.TakeClosed().empty());
  EXPECT_EQ(m.server.admission().num_tokens_in_use(), 0u);
}

// The bytes of everything that the server sends, against those that the sender of a flood paid.
TEST(SecureServer, NeverSendsMoreThanItReceives) {
  Meeting m;
  const std::uint32_t session = m.Connect();
  ASSERT_NE(session, 0u);
  std::vector<Bytes> packets;
  SecureClient other(m.token, Text("hello"), m.random);
  packets.push_back(m.Poll(other));
  for (const std::size_t size : {0, 1, 7, 8, 12, 32, 33, 56, 57, 60, 200, 1'199, 1'200, 1'232}) {
    for (int kind = 0; kind < 8; ++kind) {
      Bytes junk(size);
      m.random.Fill(junk);
      if (size > 0) junk[0] = static_cast<std::uint8_t>(kind);
      if (size > 3) junk[1] = junk[2] = junk[3] = 0;
      packets.push_back(junk);
    }
  }
  for (const char* text : {"", "a", "a longer message of a client that has moved"}) {
    packets.push_back(m.FromClient(text));
  }
  for (const PeerAddress& from : {kAway, kHome}) {
    for (const Bytes& packet : packets) {
      EXPECT_LE(m.ToServer(packet, from).reply_size, packet.size()) << int{packet[0]};
    }
  }
}

TEST(SecureServer, RefusesForgeriesOfASession) {
  Meeting m;
  const std::uint32_t session = m.Connect();
  Bytes forged = m.FromClient("pose");
  forged.back() ^= 1;
  ServerEvent event = m.ToServer(forged);
  EXPECT_EQ(event.session, 0u);
  EXPECT_EQ(event.open_status, OpenStatus::kNotAuthentic);
  EXPECT_EQ(event.reply_size, 0u);
  EXPECT_EQ(m.server.num_dropped(OpenStatus::kNotAuthentic), 1u);
  const Bytes good = m.FromClient("pose");
  EXPECT_EQ(m.ToServer(good).session, session);
  EXPECT_EQ(m.ToServer(good).open_status, OpenStatus::kDuplicate);
  // From another address, the copy does not even cause a challenge.
  EXPECT_EQ(m.ToServer(good, kAway).reply_size, 0u);
}

TEST(SecureServer, HintsThatASessionIsUnknown) {
  Meeting m;
  ASSERT_NE(m.Connect(), 0u);
  SecureServer restarted({}, m.random);
  restarted.SetKeys(m.ring);
  Bytes packet = m.FromClient("pose");
  const ServerEvent event = restarted.OnDatagram(packet, kHome, m.now);
  EXPECT_EQ(event.refusal, Refusal::kUnknownSession);
  EXPECT_EQ(event.reply_size, kRefusedBytes);
}

TEST(SecureServer, ANewAddressCountsAfterPacketAndCookie) {
  Meeting m;
  const std::uint32_t session = m.Connect();
  const Bytes moved = m.FromClient("a message that is longer than a challenge is");
  const ServerEvent event = m.ToServer(moved, kAway);
  EXPECT_EQ(event.session, session);
  EXPECT_FALSE(event.inner.empty());
  EXPECT_EQ(*m.server.AddressOf(session), kHome);
  ASSERT_EQ(event.reply_size, ControlPacketBytes(kCookieBytes));
  (void)m.ToClient(event.reply());
  const Bytes answer = m.Poll();
  // From a third address, the answer proves nothing.
  (void)m.ToServer(answer, kSameHost);
  EXPECT_EQ(*m.server.AddressOf(session), kHome);
  m.now = test::Later(m.now, SecureServer::kChallengeMicroseconds);
  (void)m.ToClient(
      m.ToServer(m.FromClient("a message that is longer than a challenge"), kAway).reply());
  (void)m.ToServer(m.Poll(), kAway);
  EXPECT_EQ(*m.server.AddressOf(session), kAway);
  // The token moved along.
  SecureClient other(m.token, Text("hello"), m.random);
  Bytes packet = m.Poll(other);
  const ServerEvent retry = m.ToServer(packet, kHome);
  (void)m.ToClient(other, retry.reply());
  EXPECT_EQ(m.ToServer(m.Poll(other), kHome).refusal, Refusal::kTokenInUse);
}

TEST(SecureServer, ANewHandshakeReplacesTheSessionOfTheSameAddress) {
  Meeting m;
  const std::uint32_t first = m.Connect();
  SecureClient restarted(m.token, Text("hello"), m.random);
  for (int step = 0; step < 3; ++step) {
    const ServerEvent event = m.ToServer(m.Poll(restarted));
    // Until the new session begins, the old one lives.
    if (!event.opened) {
      EXPECT_NE(m.server.InfoOf(first).grant, nullptr);
    }
    (void)m.ToClient(restarted, event.reply());
  }
  EXPECT_EQ(m.server.TakeClosed(), std::vector<std::uint32_t>{first});
  EXPECT_EQ(m.server.num_sessions(), 1u);
}

TEST(SecureServer, EndsSilentAndExpiredSessions) {
  Meeting m;
  const std::uint32_t session = m.Connect();
  m.server.Expire(test::Later(m.now, SecureServer::kSilenceMicroseconds - 1));
  EXPECT_EQ(m.server.num_sessions(), 1u);
  m.server.Expire(test::Later(m.now, SecureServer::kSilenceMicroseconds));
  EXPECT_EQ(m.server.TakeClosed(), std::vector<std::uint32_t>{session});
  EXPECT_TRUE(m.server.TakeClosed().empty());
  EXPECT_EQ(m.server.InfoOf(session).grant, nullptr);

  Meeting n;
  const std::uint32_t other = n.Connect();
  Now expiry = n.now;
  expiry.unix_s = test::kUnixNow + 3'600;
  // Even before Expire() runs.
  Bytes packet = n.FromClient("pose");
  EXPECT_EQ(n.server.OnDatagram(packet, kHome, expiry).session, 0u);
  PeerAddress to;
  EXPECT_EQ(n.server.Seal(other, packet, expiry, to), SealStatus::kNotConnected);
  n.server.Expire(expiry);
  EXPECT_EQ(n.server.TakeClosed(), std::vector<std::uint32_t>{other});
}

TEST(SecureServer, ARetiredKeyEndsItsSessions) {
  Meeting m;
  const std::uint32_t session = m.Connect();
  KeyRing ring = m.ring;
  ASSERT_TRUE(ring.AddNew(test::kUnixNow, test::kUnixNow + 10, m.random).ok());
  m.server.SetKeys(ring);
  EXPECT_EQ(m.server.num_sessions(), 1u);
  ASSERT_TRUE(ring.Remove(m.ring.keys()[0].id));
  m.server.SetKeys(ring);
  EXPECT_EQ(m.server.num_sessions(), 0u);
  EXPECT_EQ(m.server.TakeClosed(), std::vector<std::uint32_t>{session});
  EXPECT_EQ(m.ToServer(m.FromClient("pose")).refusal, Refusal::kUnknownSession);
  EXPECT_EQ(m.Connect(), 0u);
}

TEST(SecureServer, AClosedSessionIsForgotten) {
  Meeting m;
  const std::uint32_t session = m.Connect();
  Bytes packet(kMaxPacketBytes);
  packet.resize(m.client.Close(m.now, packet));
  const ServerEvent event = m.ToServer(packet);
  EXPECT_TRUE(event.closed);
  EXPECT_EQ(event.session, session);
  EXPECT_EQ(m.server.num_sessions(), 0u);
  EXPECT_EQ(m.server.admission().num_tokens_in_use(), 0u);
  // The next session has another index, though it may have the same place.
  const std::uint32_t next = m.Connect();
  EXPECT_NE(next, 0u);
  EXPECT_NE(next, session);
}

class Renewal : public ::testing::Test {
 protected:
  // What the server does with a token that the client shows.
  ServerEvent Show(const ClientToken& token) {
    m_.client.Renew(token);
    const Bytes packet = m_.Poll();
    EXPECT_EQ(packet.size(), ControlPacketBytes(kRenewBytes));
    ServerEvent event = m_.ToServer(packet);
    answer_ = m_.ToClient(event.reply());
    return event;
  }

  Meeting m_;
  std::uint32_t session_ = m_.Connect();
  ClientEvent answer_;
};

TEST_F(Renewal, GivesNewRightsAndTime) {
  Grant grant = test::WatchGrant();
  grant.roles = Role::kPublish;
  const ClientToken token = test::MakeTestToken(m_.ring, m_.random, grant, test::kUnixNow + 7'200);
  EXPECT_TRUE(Show(token).renewed);
  EXPECT_TRUE(answer_.renewed);
  EXPECT_TRUE(m_.Poll().size() < ControlPacketBytes(kRenewBytes));  // no more renewals
  EXPECT_EQ(m_.server.InfoOf(session_).grant->roles, Roles(Role::kPublish));
  EXPECT_EQ(m_.server.admission().num_tokens_in_use(), 1u);
  Now later = m_.now;
  later.unix_s = test::kUnixNow + 7'199;
  m_.server.Expire(later);
  EXPECT_EQ(m_.server.num_sessions(), 1u);
}

// Tokens are visible on the network. Another client must not gain rights by showing one.
TEST_F(Renewal, NeedsTheKeyOfTheToken) {
  ClientToken seen = test::MakeTestToken(m_.ring, m_.random);
  seen.key = m_.random.MakeKey();
  EXPECT_FALSE(Show(seen).renewed);
  EXPECT_EQ(answer_.refusal, Refusal::kForgedHandshake);
  EXPECT_NE(m_.server.InfoOf(session_).grant, nullptr);
}

TEST_F(Renewal, IsForTheSameClient) {
  Grant grant = test::WatchGrant();
  grant.client_id = 78;
  EXPECT_FALSE(Show(test::MakeTestToken(m_.ring, m_.random, grant)).renewed);
  EXPECT_EQ(m_.server.InfoOf(session_).grant->client_id, 77u);
}

TEST_F(Renewal, ChecksTheTokenAsAHandshakeDoes) {
  EXPECT_FALSE(
      Show(test::MakeTestToken(m_.ring, m_.random, test::WatchGrant(), test::kUnixNow)).renewed);
  EXPECT_EQ(answer_.refusal, Refusal::kExpired);
  const KeyRing others = test::MakeRing(m_.random);
  EXPECT_FALSE(Show(test::MakeTestToken(others, m_.random)).renewed);
  EXPECT_EQ(answer_.refusal, Refusal::kUnknownKey);
  Grant grant = test::WatchGrant();
  grant.audience = "elsewhere";
  EXPECT_FALSE(Show(test::MakeTestToken(m_.ring, m_.random, grant)).renewed);
  EXPECT_EQ(answer_.refusal, Refusal::kWrongAudience);
}

// The session that the client opens, one second later.
std::uint32_t OpenAfterASecond(Meeting& m, SecureClient& client, const PeerAddress& from) {
  std::uint32_t session = 0;
  m.now = test::Later(m.now, 1'000'000);
  for (int step = 0; step < 3; ++step) {
    const ServerEvent event = m.ToServer(m.Poll(client), from);
    if (event.opened) {
      EXPECT_EQ(session, 0u) << "one session";
      session = event.session;
    }
    (void)m.ToClient(client, event.reply());
  }
  EXPECT_NE(session, 0u);
  return session;
}

// The holder of one token neither fills the table with sessions nor with handshakes.
TEST(SecureServer, LimitsTheSessionsOfAToken) {
  SecureServerSettings settings;
  settings.max_sessions_of_a_token = 3;
  Meeting m(settings);
  std::vector<std::uint32_t> sessions;
  for (std::uint16_t i = 0; i < 5; ++i) {
    SecureClient client(m.token, Text("hello"), m.random);
    const PeerAddress from = FromIpv4({192, 0, 2, 1}, static_cast<std::uint16_t>(6'000 + i));
    sessions.push_back(OpenAfterASecond(m, client, from));
  }
  EXPECT_EQ(m.server.num_sessions(), 3u);
  // The two that were silent for longest.
  EXPECT_EQ(m.server.TakeClosed(), (std::vector<std::uint32_t>{sessions[0], sessions[1]}));
}

// Neither does the holder of two tokens, who moves each session to the other token.
TEST(SecureServer, LimitsTheSessionsOfATokenAfterRenewals) {
  SecureServerSettings settings;
  settings.max_sessions_of_a_token = 2;
  Meeting m(settings);
  const ClientToken next = test::MakeTestToken(m.ring, m.random);
  std::vector<std::uint32_t> sessions;
  for (std::uint16_t i = 0; i < 5; ++i) {
    SecureClient client(m.token, Text("hello"), m.random);
    const PeerAddress from = FromIpv4({192, 0, 2, 1}, static_cast<std::uint16_t>(6'000 + i));
    sessions.push_back(OpenAfterASecond(m, client, from));
    client.Renew(next);
    EXPECT_TRUE(m.ToServer(m.Poll(client), from).renewed);
  }
  EXPECT_EQ(m.server.num_sessions(), 2u);
  EXPECT_EQ(m.server.TakeClosed(),
            (std::vector<std::uint32_t>{sessions[0], sessions[1], sessions[2]}));
}

TEST(SecureServer, LimitsHandshakesThatAreNotContinued) {
  Meeting m;
  for (std::uint16_t i = 0; i < 30; ++i) {
    m.now = test::Later(m.now, 100'000);
    SecureClient client(m.token, Text("hello"), m.random);
    const PeerAddress from = FromIpv4({192, 0, 2, 1}, static_cast<std::uint16_t>(6'000 + i));
    const ServerEvent retry = m.ToServer(m.Poll(client), from);
    (void)m.ToClient(client, retry.reply());
    (void)m.ToServer(m.Poll(client), from);
  }
  EXPECT_EQ(m.server.num_sessions(), SecureServer::kMaxUnconfirmedOfAToken);
}

TEST(SecureServer, IsFullAtItsLimit) {
  SecureServerSettings settings;
  settings.max_sessions = 1;
  Meeting m(settings);
  ASSERT_NE(m.Connect(), 0u);
  const ClientToken token = test::MakeTestToken(m.ring, m.random);
  SecureClient other(token, Text("hello"), m.random);
  const ServerEvent retry = m.ToServer(m.Poll(other), kAway);
  (void)m.ToClient(other, retry.reply());
  const ServerEvent refused = m.ToServer(m.Poll(other), kAway);
  EXPECT_EQ(refused.refusal, Refusal::kFull);
  EXPECT_EQ(m.ToClient(other, refused.reply()).refusal, Refusal::kFull);
  EXPECT_EQ(other.last_refusal(), Refusal::kFull);
}

TEST(SecureServer, PacketsOfASessionAllocateNothing) {
  Meeting m;
  const std::uint32_t session = m.Connect();
  std::vector<Bytes> packets;
  for (int i = 0; i < 50; ++i) packets.push_back(m.FromClient("pose"));
  Bytes reply = test::Packet(Text("weights"));
  PeerAddress to;
  bool ok = true;
  const std::uint64_t before = furrow::test::NumAllocations();
  for (Bytes& packet : packets) {
    ok = ok && m.server.OnDatagram(packet, kHome, m.now).session == session;
    ok = ok && m.server.Seal(session, reply, m.now, to) == SealStatus::kOk;
  }
  EXPECT_EQ(furrow::test::NumAllocations(), before);
  EXPECT_TRUE(ok);
}

// A second server, as after a restart, with the keys of `m`.
class NextServer : public SecureServer {
 public:
  explicit NextServer(Meeting& m, SecureServerSettings settings = {})
      : SecureServer(settings, m.random) {
    SetKeys(m.ring);
  }
};

TEST(SecureServer, AnotherServerGoesOnWithItsSessions) {
  Meeting m;
  const std::uint32_t session = m.Connect();
  const Bytes late = m.FromClient("late");
  Bytes repeated = m.FromClient("pose");
  Bytes first = test::Packet(Text("first"));
  PeerAddress to;
  ASSERT_EQ(m.server.Seal(session, first, m.now, to), SealStatus::kOk);
  ASSERT_EQ(m.ToServer(repeated).session, session);

  const std::vector<SessionState> states = m.server.TakeAll();
  ASSERT_EQ(states.size(), 1u);
  Bytes never = test::Packet(Text("never"));
  EXPECT_EQ(m.server.Seal(session, never, m.now, to), SealStatus::kNotConnected);
  EXPECT_EQ(m.server.num_sessions(), 0u);
  EXPECT_EQ(m.server.admission().num_tokens_in_use(), 0u);

  NextServer next(m);
  ASSERT_TRUE(next.Resume(states[0], m.now));
  EXPECT_FALSE(next.Resume(states[0], m.now)) << "the number is taken";
  EXPECT_EQ(next.admission().num_tokens_in_use(), 1u);
  EXPECT_EQ(next.InfoOf(session).grant->subjects, "stage-*");
  // The server knows the counters that its predecessor has received. Others are new.
  EXPECT_EQ(next.OnDatagram(repeated, kHome, m.now).open_status, OpenStatus::kDuplicate);
  Bytes arrives = late;
  ServerEvent event = next.OnDatagram(arrives, kHome, m.now);
  EXPECT_EQ(event.session, session);
  EXPECT_FALSE(event.opened);
  EXPECT_EQ(Bytes(event.inner.begin(), event.inner.end()), Text("late"));
  // No counter is used twice, so the client takes both packets.
  Bytes second = test::Packet(Text("second"));
  ASSERT_EQ(next.Seal(session, second, m.now, to), SealStatus::kOk);
  EXPECT_EQ(to, kHome);
  for (const auto& [packet, text] : {std::pair(second, "second"), std::pair(first, "first")}) {
    const ClientEvent received = m.ToClient(packet);
    EXPECT_EQ(Bytes(received.inner.begin(), received.inner.end()), Text(text));
  }
  // New sessions get other numbers.
  const ClientToken token = test::MakeTestToken(m.ring, m.random);
  SecureClient other(token, Text("hello"), m.random);
  for (int i = 0; i < 2; ++i) {
    Bytes initiation = m.Poll(other);
    const ServerEvent answer = next.OnDatagram(initiation, kAway, m.now);
    (void)m.ToClient(other, answer.reply());
  }
  EXPECT_EQ(next.num_sessions(), 2u);
  next.Close(session);
  EXPECT_EQ(next.admission().num_tokens_in_use(), 1u);
}

// The key changes by time, so the next server must know when it changed last.
TEST(SecureServer, AnotherServerGoesOnWithTheKeysInForce) {
  Meeting m;
  const std::uint32_t session = m.Connect();
  for (int i = 0; i < 3; ++i) {
    m.now = test::Later(m.now, RekeyLimits().microseconds);
    ASSERT_EQ(m.ToServer(m.FromClient("pose")).session, session);
    NextServer next(m);
    const auto states = m.server.TakeAll();
    ASSERT_EQ(states.size(), 1u);
    ASSERT_TRUE(next.Resume(states[0], m.now));
    Bytes packet = m.FromClient("again");
    EXPECT_EQ(next.OnDatagram(packet, kHome, m.now).session, session);
    Bytes reply = test::Packet(Text("weights"));
    PeerAddress to;
    ASSERT_EQ(next.Seal(session, reply, m.now, to), SealStatus::kOk);
    EXPECT_FALSE(m.ToClient(reply).inner.empty());
    const auto back = next.TakeAll();
    ASSERT_EQ(back.size(), 1u);
    ASSERT_TRUE(m.server.Resume(back[0], m.now));
  }
}

TEST(SecureServer, GoesOnWithNoSessionThatMayNotBeHere) {
  Meeting m;
  (void)m.Connect();
  const auto states = m.server.TakeAll();
  ASSERT_EQ(states.size(), 1u);
  const SessionState& good = states[0];
  NextServer next(m, {.max_sessions = 2});
  SessionState high = good;
  high.index = good.index | 2;
  EXPECT_FALSE(next.Resume(high, m.now));
  SessionState unnumbered = good;
  unnumbered.index = 1;
  EXPECT_FALSE(next.Resume(unnumbered, m.now));
  SessionState unknown = good;
  ++unknown.key_id;
  EXPECT_FALSE(next.Resume(unknown, m.now));
  Now later = m.now;
  later.unix_s = good.expires;
  EXPECT_FALSE(next.Resume(good, later));
  EXPECT_EQ(next.num_sessions(), 0u);
  // Places below one in use stay free.
  SessionState second = good;
  second.index = good.index | 1;
  EXPECT_TRUE(next.Resume(second, m.now));
  EXPECT_TRUE(next.Resume(good, m.now));
  EXPECT_EQ(next.num_sessions(), 2u);
}

// A handshake that its client has not continued is begun again.
TEST(SecureServer, LeavesNoSessionThatHasNotBegun) {
  Meeting m;
  (void)m.ToClient(m.ToServer(m.Poll()).reply());
  (void)m.ToServer(m.Poll());
  EXPECT_EQ(m.server.num_sessions(), 1u);
  EXPECT_TRUE(m.server.TakeAll().empty());
}

}  // namespace
}  // namespace furrow::protocol::secure
