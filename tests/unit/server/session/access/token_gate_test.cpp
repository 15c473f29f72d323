// SPDX-License-Identifier: Apache-2.0
#include "server/session/access/token_gate.h"

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "protocol/secure/token/token_text.h"
#include "tests/unit/protocol/secure/secure_testing.h"

namespace furrow::server {
namespace {

namespace secure = protocol::secure;
using secure::test::kUnixNow;
using testing::HasSubstr;

class TokenGateTest : public testing::Test {
 protected:
  TokenGateTest() { gate.SetKeys(ring); }

  Result<Access> Admit(const secure::ClientToken& token, bool local = true) {
    return gate.Admit(ToText(token), local, FromSeconds(100));
  }
  std::string Refusal(const secure::ClientToken& token) {
    const auto access = Admit(token);
    return access.ok() ? "" : access.status().what();
  }

  secure::test::RepeatableRandom random{1};
  const secure::KeyRing ring = secure::test::MakeRing(random);
  std::uint64_t unix_now = kUnixNow;
  Metrics metrics;
  TokenGate gate{{.security = Security::kRequired, .name = "stage", .tokens_in_clear = false},
                 [this] { return unix_now; },
                 &metrics};
};

TEST_F(TokenGateTest, AValidTokenGivesItsGrantUntilItExpires) {
  const auto access = Admit(secure::test::MakeTestToken(ring, random));
  ASSERT_TRUE(access.ok()) << access.status().ToString();
  EXPECT_TRUE(access->MayWatch("stage-1"));
  EXPECT_FALSE(access->MayWatch("ann"));
  EXPECT_EQ(access->expires(), FromSeconds(100 + 3600));
  EXPECT_TRUE(gate.HasKey(access->key_id()));
}

TEST_F(TokenGateTest, EachInvalidTokenIsRefusedAndCounted) {
  EXPECT_THAT(gate.Admit("nonsense", true, Time(0)).status().what(), HasSubstr("malformed"));
  secure::Grant elsewhere = secure::test::WatchGrant();
  elsewhere.audience = "studio";
  EXPECT_THAT(Refusal(secure::test::MakeTestToken(ring, random, elsewhere)),
              HasSubstr("another server"));
  secure::ClientToken forged = secure::test::MakeTestToken(ring, random);
  forged.bytes[60] ^= 1;
  EXPECT_THAT(Refusal(forged), HasSubstr("changed"));
  EXPECT_THAT(
      Refusal(secure::test::MakeTestToken(ring, random, secure::test::WatchGrant(), kUnixNow)),
      HasSubstr("expired"));
  EXPECT_THAT(Refusal(secure::test::MakeTestToken(secure::test::MakeRing(random), random)),
              HasSubstr("does not have the key"));
  EXPECT_EQ(metrics.Get(Counter::kRefusedMalformed), 1u);
  EXPECT_EQ(metrics.Get(Counter::kRefusedWrongServer), 1u);
  EXPECT_EQ(metrics.Get(Counter::kRefusedForgedToken), 1u);
  EXPECT_EQ(metrics.Get(Counter::kRefusedExpired), 1u);
  EXPECT_EQ(metrics.Get(Counter::kRefusedUnknownKey), 1u);
}

// The bytes of a token travel in clear text over UDP; its key does not.
TEST_F(TokenGateTest, ATokenIsWorthNothingWithoutItsKey) {
  secure::ClientToken seen = secure::test::MakeTestToken(ring, random);
  seen.key = random.MakeKey();
  EXPECT_THAT(Refusal(seen), HasSubstr("changed"));
}

TEST_F(TokenGateTest, OtherComputersShowNothingInClearText) {
  const secure::ClientToken token = secure::test::MakeTestToken(ring, random);
  EXPECT_THAT(Admit(token, /*shielded=*/false).status().what(), HasSubstr("not encrypted"));
  EXPECT_EQ(metrics.Get(Counter::kRefusedInClear), 1u);
  TokenGate lenient(
      {.security = Security::kRequired, .name = "", .tokens_in_clear = true},
      [this] { return unix_now; }, &metrics);
  lenient.SetKeys(ring);
  EXPECT_TRUE(lenient.Admit(ToText(token), /*shielded=*/false, Time(0)).ok());
  // Nobody is asked for a token that would be refused after it was sent.
  EXPECT_STREQ(gate.WhyNeeded(/*shielded=*/true), kNeedsTokenText);
  EXPECT_STREQ(gate.WhyNeeded(/*shielded=*/false), kNoTokenHereText);
  EXPECT_STREQ(lenient.WhyNeeded(/*shielded=*/false), kNeedsTokenText);
}

TEST_F(TokenGateTest, ARetiredKeyIsGone) {
  const secure::ClientToken token = secure::test::MakeTestToken(ring, random);
  gate.SetKeys({});
  EXPECT_FALSE(gate.HasKey(ring.keys().front().id));
  EXPECT_THAT(Refusal(token), HasSubstr("does not have the key"));
}

TEST_F(TokenGateTest, StrangersGetWhatTheModeSays) {
  EXPECT_FALSE(gate.Stranger().admitted());
  TokenGate open(
      {}, [] { return std::uint64_t{0}; }, &metrics);
  EXPECT_TRUE(open.Stranger().MayPublish("ann"));
}

TEST_F(TokenGateTest, FarExpiriesAreWithinTheClock) {
  EXPECT_GT(gate.ExpiryOf(~std::uint64_t{0}, Time(0)), FromSeconds(1e9));
  EXPECT_EQ(gate.ExpiryOf(1, FromSeconds(5)), FromSeconds(5)) << "expired already";
}

}  // namespace
}  // namespace furrow::server
