// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/session/secure_client.h"

#include <gtest/gtest.h>

#include "protocol/messages/bytes.h"
#include "tests/unit/protocol/secure/session/session_testing.h"

namespace furrow::protocol::secure {
namespace {

using test::Bytes;
using test::Meeting;
using test::Text;

Bytes Copy(ByteView bytes) { return {bytes.begin(), bytes.end()}; }

class SecureClientTest : public ::testing::Test {
 protected:
  // The times at which the client sends something within a period, in milliseconds.
  [[nodiscard]] std::vector<int> SendTimes(int milliseconds) {
    std::vector<int> times;
    for (int ms = 0; ms < milliseconds; ms += 10) {
      if (!m_.Poll().empty()) times.push_back(ms);
      m_.now = test::Later(m_.now, 10'000);
    }
    return times;
  }
  [[nodiscard]] Bytes Refused(Refusal refusal, const Bytes& packet) {
    return Copy(WriteRefused(LoadLittle<std::uint32_t>(&packet[4]), refusal));
  }

  Meeting m_;
};

TEST_F(SecureClientTest, RepeatsTheSameInitiation) {
  const Bytes first = m_.Poll();
  EXPECT_TRUE(m_.Poll().empty());
  m_.now = test::Later(m_.now, 200'000);
  // Byte for byte: the same key pair must not encrypt anything else.
  EXPECT_EQ(m_.Poll(), first);
  m_.now = test::Later(m_.now, 10'000);
  EXPECT_EQ(SendTimes(1'300), (std::vector<int>{390, 790, 1'190}));
}

TEST_F(SecureClientTest, ARetryNeedsTheIndexAndGivesANewKeyPair) {
  const Bytes first = m_.Poll();
  const Bytes retry = Copy(m_.ToServer(first).reply());
  Bytes foreign = retry;
  foreign[4] ^= 1;
  EXPECT_EQ(m_.ToClient(foreign).open_status, OpenStatus::kBadHeader);
  EXPECT_TRUE(m_.Poll().empty());
  (void)m_.ToClient(retry);
  const Bytes second = m_.Poll();
  ASSERT_EQ(second.size(), kInitiationBytes);
  EXPECT_NE(
      Bytes(first.begin() + kInitiationMessageAt, first.begin() + kInitiationMessageAt + 32),
      Bytes(second.begin() + kInitiationMessageAt, second.begin() + kInitiationMessageAt + 32));
  // The copy of the retry is for an initiation that is over.
  (void)m_.ToClient(retry);
  EXPECT_TRUE(m_.Poll().empty());
}

TEST_F(SecureClientTest, RetriesWithoutEndAreNotAnsweredWithoutEnd) {
  int initiations = 0;
  Bytes packet = m_.Poll();
  for (int i = 0; i < 1'000; ++i) {
    m_.now = test::Later(m_.now, 100);
    (void)m_.ToClient(WriteRetry(LoadLittle<std::uint32_t>(&packet[4]), Cookie{}));
    const Bytes next = m_.Poll();
    if (next.empty()) continue;
    ++initiations;
    packet = next;
  }
  EXPECT_LE(initiations, 6);
}

TEST_F(SecureClientTest, RefusesEveryFlippedBitOfAResponse) {
  (void)m_.ToClient(Copy(m_.ToServer(m_.Poll()).reply()));
  const Bytes response = Copy(m_.ToServer(m_.Poll()).reply());
  ASSERT_EQ(response.size(), kResponseBytes);
  for (std::size_t bit = 0; bit < response.size() * 8; ++bit) {
    Bytes changed = response;
    changed[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
    EXPECT_FALSE(m_.ToClient(changed).connected) << bit;
  }
  EXPECT_TRUE(m_.ToClient(response).connected);
  EXPECT_FALSE(m_.ToClient(response).connected);
}

TEST_F(SecureClientTest, ShowsTheReasonAndKeepsTrying) {
  const Bytes packet = m_.Poll();
  EXPECT_EQ(m_.ToClient(Refused(Refusal::kExpired, packet)).refusal, Refusal::kExpired);
  EXPECT_EQ(m_.client.last_refusal(), Refusal::kExpired);
  // Less often, since time alone does not help.
  EXPECT_EQ(SendTimes(3'000), (std::vector<int>{200, 600, 1'600, 2'600}));
  Bytes foreign = packet;
  foreign[4] ^= 1;
  EXPECT_EQ(m_.ToClient(Refused(Refusal::kFull, foreign)).refusal, Refusal::kNone);
  // A server that accepts the token after all.
  EXPECT_NE(m_.Connect(), 0u);
  EXPECT_EQ(m_.client.last_refusal(), Refusal::kNone);
}

TEST_F(SecureClientTest, ProbesAndConnectsAgainInSilence) {
  ASSERT_NE(m_.Connect(), 0u);
  (void)SendTimes(10);
  std::vector<std::size_t> sizes;
  for (int ms = 0; ms < 2'000; ms += 10) {
    if (const Bytes packet = m_.Poll(); !packet.empty()) sizes.push_back(packet.size());
    m_.now = test::Later(m_.now, 10'000);
  }
  const std::size_t probe = ControlPacketBytes(kCookieBytes);
  const auto first = std::find(sizes.begin(), sizes.end(), kInitiationBytes);
  EXPECT_GE(first - sizes.begin(), 4);
  EXPECT_EQ(std::count(sizes.begin(), first, probe), first - sizes.begin());
  ASSERT_NE(first, sizes.end());
  // The session still works, and a packet of it ends the attempt.
  EXPECT_TRUE(m_.client.connected());
  const ServerEvent event = m_.ToServer(m_.FromClient("pose"));
  Bytes packet = test::Packet(Text("weights"));
  PeerAddress to;
  ASSERT_EQ(m_.server.Seal(event.session, packet, m_.now, to), SealStatus::kOk);
  EXPECT_FALSE(m_.ToClient(packet).inner.empty());
  EXPECT_TRUE(m_.Poll().empty());
  // Without any, the session is lost in the end.
  m_.now = test::Later(m_.now, SecureClient::kLostMicroseconds);
  (void)m_.Poll();
  EXPECT_FALSE(m_.client.connected());
  Bytes pose = test::Packet(Text("pose"));
  EXPECT_EQ(m_.client.Seal(pose, m_.now), SealStatus::kNotConnected);
}

TEST_F(SecureClientTest, AHintOfAnUnknownSessionEndsNothing) {
  const std::uint32_t session = m_.Connect();
  m_.now = test::Later(m_.now, 600'000);
  EXPECT_EQ(m_.ToClient(WriteRefused(session ^ 1, Refusal::kUnknownSession)).open_status,
            OpenStatus::kOk);
  EXPECT_LT(m_.Poll().size(), kInitiationBytes);
  (void)m_.ToClient(WriteRefused(session, Refusal::kUnknownSession));
  EXPECT_EQ(m_.Poll().size(), kInitiationBytes);
  EXPECT_TRUE(m_.client.connected());
}

TEST_F(SecureClientTest, ANewTokenBeforeTheSessionIsSimplyUsed) {
  (void)m_.Poll();
  const ClientToken token = test::MakeTestToken(m_.ring, m_.random);
  m_.client.Renew(token);
  const Bytes packet = m_.Poll();
  ASSERT_EQ(packet.size(), kInitiationBytes);
  EXPECT_TRUE(std::equal(token.bytes.begin(), token.bytes.end(), packet.begin() + 8));
  EXPECT_NE(m_.Connect(), 0u);
  EXPECT_EQ(m_.Poll().size(), 0u);
}

TEST_F(SecureClientTest, ClosesOnce) {
  const std::uint32_t session = m_.Connect();
  ASSERT_NE(session, 0u);
  Bytes packet(kMaxPacketBytes);
  EXPECT_EQ(m_.client.Close(m_.now, packet), ControlPacketBytes(0));
  EXPECT_FALSE(m_.client.connected());
  EXPECT_EQ(m_.client.Close(m_.now, packet), 0u);
}

TEST_F(SecureClientTest, IgnoresWhatIsForServers) {
  const Bytes initiation = m_.Poll();
  EXPECT_FALSE(m_.ToClient(initiation).connected);
  EXPECT_FALSE(m_.ToClient({}).connected);
  EXPECT_EQ(m_.ToClient(Bytes(40, 5)).open_status, OpenStatus::kBadHeader);
  Bytes data(40);
  WritePacketHeader({PacketKind::kData, false, 1, 1}, data);
  EXPECT_EQ(m_.ToClient(data).open_status, OpenStatus::kUnknownSession);
}

}  // namespace
}  // namespace furrow::protocol::secure
