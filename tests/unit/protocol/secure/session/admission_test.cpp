// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/session/admission.h"

#include <gtest/gtest.h>

#include "tests/unit/allocation_counter.h"
#include "tests/unit/protocol/drill.h"
#include "tests/unit/protocol/secure/session/session_testing.h"

namespace furrow::protocol::secure {
namespace {

using test::Bytes;
using test::kAway;
using test::kHome;
using test::kNow;
using test::kSameHost;

// Writes initiations by hand, so that each test can break one part.
class AdmissionTest : public ::testing::Test {
 protected:
  AdmissionTest() : token_(test::MakeTestToken(ring_, random_)) { admission_.SetKeys(ring_); }

  [[nodiscard]] Bytes Initiation(const ClientToken& token, const Cookie& cookie,
                                 const Key* psk = nullptr) {
    Bytes datagram(kInitiationBytes);
    WriteInitiationHead(42, token.bytes, cookie, datagram);
    Handshake handshake(Handshake::Side::kInitiator, psk != nullptr ? *psk : token.key,
                        PrologueOf(ByteView(datagram).first(kInitiationMessageAt)), random_);
    std::array<std::uint8_t, kInitiationPayloadBytes> payload{};
    payload[0] = 5;
    EXPECT_EQ(handshake.Write(payload, ByteSpan(datagram).subspan(kInitiationMessageAt)),
              HandshakeStatus::kOk);
    return datagram;
  }
  AdmissionResult Send(const Bytes& datagram, const PeerAddress& from = kHome, Now now = kNow,
                       std::uint32_t index = 1) {
    accepted_ = {};
    return admission_.OnInitiation(datagram, from, now, index, accepted_);
  }
  [[nodiscard]] Cookie CookieFor(const ClientToken& token, const PeerAddress& from = kHome,
                                 Now now = kNow) {
    const AdmissionResult result = Send(Initiation(token, Cookie{}), from, now);
    EXPECT_EQ(result.outcome, AdmissionOutcome::kRetry);
    std::uint32_t index = 0;
    Cookie cookie{};
    EXPECT_TRUE(ReadRetry(ByteView(result.reply_bytes).first(result.reply_size), index, cookie));
    EXPECT_EQ(index, 42u);
    return cookie;
  }
  // The reason for an initiation with a good cookie.
  [[nodiscard]] Refusal RefusalOf(const ClientToken& token, const PeerAddress& from = kHome,
                                  Now now = kNow, std::uint32_t index = 1) {
    const AdmissionResult result =
        Send(Initiation(token, CookieFor(token, from, now)), from, now, index);
    if (result.outcome == AdmissionOutcome::kAccepted) return Refusal::kNone;
    EXPECT_EQ(result.outcome, AdmissionOutcome::kRefused);
    std::uint32_t client = 0;
    Refusal hint = Refusal::kNone;
    EXPECT_TRUE(ReadRefused(ByteView(result.reply_bytes).first(result.reply_size), client, hint));
    EXPECT_EQ(hint, result.refusal);
    EXPECT_EQ(client, 42u);
    return result.refusal;
  }

  test::RepeatableRandom random_;
  KeyRing ring_ = test::MakeRing(random_);
  ClientToken token_;
  // Time stands still in most tests, and all clients are one host.
  Admission admission_{{.audience = "stage-a",
                        .attempts_per_second = 100'000,
                        .attempts_per_second_of_a_host = 100'000},
                       random_};
  AcceptedHandshake accepted_;
};

// With the limits of a server.
class AttemptsTest : public AdmissionTest {
 protected:
  AttemptsTest() {
    limited_.SetKeys(ring_);
    stolen_.key = random_.MakeKey();
  }
  // How many of `count` attempts with a wrong key are examined.
  int Examined(const PeerAddress& from, int count) {
    int examined = 0;
    for (int i = 0; i < count; ++i) examined += Try(stolen_, from) == Refusal::kForgedHandshake;
    return examined;
  }
  Refusal Try(const ClientToken& token, const PeerAddress& from) {
    Cookie cookie{};
    AdmissionResult result =
        limited_.OnInitiation(Initiation(token, cookie), from, kNow, 1, accepted_);
    std::uint32_t index = 0;
    EXPECT_TRUE(ReadRetry(ByteView(result.reply_bytes).first(result.reply_size), index, cookie));
    return limited_.OnInitiation(Initiation(token, cookie), from, kNow, 1, accepted_).refusal;
  }

  Admission limited_{{}, random_};
  ClientToken stolen_ = token_;
};

TEST_F(AdmissionTest, AsksForTheCookieFirst) {
  const Cookie cookie = CookieFor(token_);
  EXPECT_EQ(admission_.num_retries(), 1u);
  const AdmissionResult result = Send(Initiation(token_, cookie));
  ASSERT_EQ(result.outcome, AdmissionOutcome::kAccepted);
  EXPECT_EQ(result.reply_size, kResponseBytes);
  EXPECT_EQ(accepted_.grant.client_id, 77u);
  EXPECT_EQ(accepted_.hello, Bytes(5));
  EXPECT_EQ(accepted_.expires, test::kUnixNow + 3'600);
  EXPECT_EQ(admission_.num_tokens_in_use(), 1u);
}

TEST_F(AdmissionTest, RefusesEveryFlippedBit) {
  const Bytes good = Initiation(token_, CookieFor(token_));
  for (std::size_t bit = 0; bit < good.size() * 8; ++bit) {
    Bytes changed = good;
    changed[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
    const AdmissionResult result = Send(changed);
    ASSERT_TRUE(result.outcome == AdmissionOutcome::kRefused ||
                result.outcome == AdmissionOutcome::kRetry)
        << bit;
    // Answers are small, so nobody can be flooded through this server.
    ASSERT_LE(result.reply_size, kRetryBytes);
  }
  EXPECT_EQ(Send(good).outcome, AdmissionOutcome::kAccepted);
}

TEST_F(AdmissionTest, RefusesOtherSizesSilently) {
  const Bytes good = Initiation(token_, CookieFor(token_));
  protocol::test::ForEveryTruncation(good, [&](std::span<const std::uint8_t> cut) {
    const AdmissionResult result = Send({cut.begin(), cut.end()});
    EXPECT_EQ(result.refusal, Refusal::kBadInitiation);
    EXPECT_EQ(result.reply_size, 0u);
  });
  Bytes longer = good;
  longer.push_back(0);
  EXPECT_EQ(Send(longer).refusal, Refusal::kBadInitiation);
}

// Each reason, in the order of the checks. A packet with several faults gets the cheapest one.
TEST_F(AdmissionTest, NamesTheReason) {
  Bytes datagram = Initiation(token_, Cookie{});
  datagram[8] = 'X';
  EXPECT_EQ(Send(datagram).refusal, Refusal::kBadToken);
  EXPECT_EQ(Send(datagram).reply_size, 0u);

  KeyRing others = test::MakeRing(random_);
  const ClientToken unknown = test::MakeTestToken(others, random_);
  EXPECT_EQ(Send(Initiation(unknown, Cookie{})).refusal, Refusal::kUnknownKey);

  const ClientToken expired =
      test::MakeTestToken(ring_, random_, test::WatchGrant(), test::kUnixNow);
  EXPECT_EQ(Send(Initiation(expired, Cookie{})).refusal, Refusal::kExpired);
  EXPECT_EQ(Send(Initiation(token_, Cookie{}), kHome, test::Later(kNow, 3'600'000'000)).refusal,
            Refusal::kExpired);

  ClientToken forged = token_;
  forged.bytes[100] ^= 1;
  EXPECT_EQ(RefusalOf(forged), Refusal::kForgedToken);

  Grant grant = test::WatchGrant();
  grant.audience = "stage-b";
  EXPECT_EQ(RefusalOf(test::MakeTestToken(ring_, random_, grant)), Refusal::kWrongAudience);
  grant.audience = "stage-a";
  EXPECT_EQ(RefusalOf(test::MakeTestToken(ring_, random_, grant)), Refusal::kNone);

  // Somebody saw the token on the network and does not know its key.
  ClientToken stolen = token_;
  stolen.key = random_.MakeKey();
  EXPECT_EQ(RefusalOf(stolen), Refusal::kForgedHandshake);

  EXPECT_EQ(RefusalOf(token_, kHome, kNow, 0), Refusal::kFull);
  EXPECT_EQ(admission_.num_refused(Refusal::kBadToken), 2u);
  EXPECT_EQ(admission_.num_refused(Refusal::kExpired), 2u);
  EXPECT_EQ(admission_.num_refused(Refusal::kFull), 1u);
}

TEST_F(AdmissionTest, AKeyThatWasRetiredOrExpiredTakesItsTokensAlong) {
  EXPECT_EQ(RefusalOf(token_), Refusal::kNone);
  admission_.SetKeys(KeyRing());
  EXPECT_EQ(Send(Initiation(token_, Cookie{})).refusal, Refusal::kUnknownKey);
  KeyRing short_lived;
  (void)short_lived.AddNew(test::kUnixNow, test::kUnixNow + 10, random_);
  admission_.SetKeys(short_lived);
  const ClientToken token = test::MakeTestToken(short_lived, random_);
  EXPECT_EQ(RefusalOf(token), Refusal::kNone);
  EXPECT_EQ(accepted_.expires, test::kUnixNow + 10);
  EXPECT_EQ(Send(Initiation(token, Cookie{}), kHome, test::Later(kNow, 10'000'000)).refusal,
            Refusal::kExpired);
}

TEST_F(AdmissionTest, ACookieOfAnotherAddressOrTokenEarnsARetry) {
  const Cookie cookie = CookieFor(token_);
  EXPECT_EQ(Send(Initiation(token_, cookie), kAway).outcome, AdmissionOutcome::kRetry);
  EXPECT_EQ(Send(Initiation(token_, cookie), kSameHost).outcome, AdmissionOutcome::kRetry);
  const ClientToken other = test::MakeTestToken(ring_, random_);
  EXPECT_EQ(Send(Initiation(other, cookie)).outcome, AdmissionOutcome::kRetry);
  EXPECT_EQ(Send(Initiation(token_, cookie), kHome, test::Later(kNow, 120'000'000)).outcome,
            AdmissionOutcome::kRetry);
}

TEST_F(AdmissionTest, RepeatsTheResponseInsteadOfComputingAnother) {
  const Bytes datagram = Initiation(token_, CookieFor(token_));
  const AdmissionResult first = Send(datagram);
  ASSERT_EQ(first.outcome, AdmissionOutcome::kAccepted);
  const PublicKey client_key = accepted_.client_key;
  TokenUse* const use = accepted_.use;
  const AdmissionResult again = Send(datagram);
  EXPECT_EQ(again.outcome, AdmissionOutcome::kRepeated);
  EXPECT_EQ(again.reply_bytes, first.reply_bytes);
  EXPECT_EQ(admission_.num_accepted(), 1u);
  // When the session has ended, nothing is left of it.
  admission_.Release(client_key, use, 1);
  EXPECT_EQ(admission_.num_tokens_in_use(), 0u);
  EXPECT_EQ(Send(datagram).outcome, AdmissionOutcome::kAccepted);
}

TEST_F(AdmissionTest, ATokenInUseIsForOneHost) {
  EXPECT_EQ(RefusalOf(token_, kHome), Refusal::kNone);
  EXPECT_EQ(RefusalOf(token_, kSameHost), Refusal::kNone);
  EXPECT_EQ(RefusalOf(token_, kAway), Refusal::kTokenInUse);
  // Its sessions are silent: the holder has moved.
  const Now later = test::Later(kNow, Admission::kTokenHoldMicroseconds);
  EXPECT_EQ(RefusalOf(token_, kAway, later), Refusal::kNone);
  EXPECT_EQ(RefusalOf(token_, kHome, later), Refusal::kTokenInUse);
}

// Each attempt costs an opened token and a checked proof, also with a wrong key.
TEST_F(AttemptsTest, OneHostCannotUseUpTheAttemptsOfAll) {
  EXPECT_EQ(Examined(kAway, 300), 100);
  EXPECT_EQ(limited_.num_refused(Refusal::kBusy), 200u);
  EXPECT_EQ(Try(token_, kHome), Refusal::kNone) << "another host";
}

// All addresses of an IPv6 network of 64 bits are one host.
TEST_F(AttemptsTest, AStrangerDoesNotLockOutItsNeighbours) {
  PeerAddress stranger;
  stranger.host = {0xfd, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  PeerAddress neighbour = stranger;
  neighbour.host[15] = 16;
  ClientToken invented = token_;
  invented.bytes[100] ^= 1;
  for (int i = 0; i < 300; ++i) ASSERT_EQ(Try(invented, stranger), Refusal::kForgedToken);
  // Somebody with a copy of a token uses up the budget of that token alone.
  EXPECT_EQ(Examined(stranger, 300), 100);
  EXPECT_EQ(Try(test::MakeTestToken(ring_, random_), neighbour), Refusal::kNone);
}

TEST_F(AttemptsTest, TheAttemptsOfAllHostsAreLimited) {
  int examined = 0;
  for (std::uint8_t host = 1; host <= 40; ++host) {
    examined += Examined(FromIpv4({10, 0, host, 1}, 5000), 100);
  }
  EXPECT_EQ(examined, 2000);
}

TEST_F(AdmissionTest, OneTokenCannotUseUpTheHandshakesOfAll) {
  int accepted = 0;
  for (int i = 0; i < 30; ++i) accepted += RefusalOf(token_) == Refusal::kNone;
  EXPECT_EQ(accepted, 10);
  EXPECT_EQ(admission_.num_refused(Refusal::kBusy), 20u);
  EXPECT_EQ(RefusalOf(test::MakeTestToken(ring_, random_)), Refusal::kNone);
  EXPECT_EQ(RefusalOf(token_, kHome, test::Later(kNow, 100'000)), Refusal::kNone);
  EXPECT_EQ(RefusalOf(token_, kHome, test::Later(kNow, 100'000)), Refusal::kBusy);
}

// A flood of good tokens: the budget of all holds, and refused handshakes leave nothing behind.
TEST_F(AdmissionTest, TheNumberOfHandshakesIsLimited) {
  int accepted = 0;
  for (int i = 0; i < 520; ++i) {
    accepted += RefusalOf(test::MakeTestToken(ring_, random_)) == Refusal::kNone;
  }
  EXPECT_EQ(accepted, 500);
  EXPECT_EQ(admission_.num_tokens_in_use(), 500u);
}

// Nothing is kept or allocated for an address that has not proved itself.
TEST_F(AdmissionTest, StrangersLeaveNoState) {
  const Bytes datagram = Initiation(token_, Cookie{});
  (void)Send(datagram);  // the first cookie of a slot
  accepted_ = {};
  const std::uint64_t before = furrow::test::NumAllocations();
  bool ok = true;
  for (std::uint32_t i = 0; i < 2'000; ++i) {
    const PeerAddress from =
        FromIpv4({10, 0, static_cast<std::uint8_t>(i >> 8), static_cast<std::uint8_t>(i)}, 9);
    ok = ok && admission_.OnInitiation(datagram, from, kNow, 1, accepted_).outcome ==
                   AdmissionOutcome::kRetry;
  }
  EXPECT_EQ(furrow::test::NumAllocations(), before);
  EXPECT_TRUE(ok);
  EXPECT_EQ(admission_.num_tokens_in_use(), 0u);
}

}  // namespace
}  // namespace furrow::protocol::secure
