// SPDX-License-Identifier: Apache-2.0
#include "server/session/access/token_issuer.h"

#include <chrono>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow::server {
namespace {

namespace secure = protocol::secure;
using testing::HasSubstr;

constexpr std::uint64_t kIssuerNow = 1'000'000;

class TokenIssuerTest : public testing::Test {
 protected:
  void SetUp() override {
    key_id = *ring.AddNew(kIssuerNow, kIssuerNow + 10'000, secure::SystemRandom());
    gate.SetKeys(ring);
    own.roles = secure::Roles(Role::kOperate) | Role::kWatch;
    own.subjects = "stage-*, ann";
    own.packets_per_second = 100;
    own.audience = "a";
  }
  [[nodiscard]] Access Maker() const {
    return Access::Of(own, key_id, now + std::chrono::hours(1));
  }
  Result<TokenIssuer::Issued> Issue(secure::Roles roles, const std::string& subjects = {},
                                    std::uint64_t seconds = 60) {
    return issuer.Issue(Maker(), {.roles = roles, .subjects = subjects, .seconds = seconds}, now);
  }

  Metrics metrics;
  TokenGate gate{
      {.security = Security::kRequired, .name = "a"}, [] { return kIssuerNow; }, &metrics};
  TokenIssuer issuer{&gate, &metrics};
  secure::KeyRing ring;
  std::uint32_t key_id = 0;
  secure::Grant own;
  Time now = std::chrono::seconds(50);
};

TEST_F(TokenIssuerTest, ANewTokenOpensTheDoorAsItSays) {
  const auto issued = Issue(Role::kWatch, "stage-*");
  ASSERT_TRUE(issued.ok()) << issued.status().ToString();
  EXPECT_EQ(issued->expires, kIssuerNow + 60);
  const auto access = gate.Admit(issued->text, /*shielded=*/true, now);
  ASSERT_TRUE(access.ok()) << access.status().ToString();
  EXPECT_TRUE(access->MayWatch("stage-bob"));
  EXPECT_FALSE(access->MayWatch("ann"));
  EXPECT_FALSE(access->Has(Role::kOperate));
  EXPECT_EQ(access->packets_per_second(), 100u) << "that of the maker";
  EXPECT_EQ(access->grant().audience, "a");
  EXPECT_EQ(access->expires(), now + std::chrono::seconds(60));
  EXPECT_EQ(metrics.Get(Counter::kTokensMade), 1u);
  EXPECT_EQ(Issue(Role::kWatch)->subjects, own.subjects) << "those of the maker";
}

TEST_F(TokenIssuerTest, NobodyGivesMoreThanTheyHave) {
  EXPECT_EQ(Issue(Role::kPublish).status().where(), "roles");
  EXPECT_EQ(Issue(secure::Roles(Role::kWatch) | Role::kDirect).status().where(), "roles");
  EXPECT_EQ(Issue(Role::kWatch, "*").status().where(), "subjects");
  EXPECT_EQ(Issue(Role::kWatch, "stage-a*").status().where(), "subjects") << "not certainly within";
  EXPECT_EQ(Issue(Role::kWatch, "ann,bob").status().where(), "subjects");
  EXPECT_EQ(Issue(Role::kWatch, {}, 3601).status().where(), "for");
  EXPECT_TRUE(Issue(Role::kWatch, {}, 3600).ok());
  EXPECT_TRUE(Issue(Role::kWatch, "ann,stage-bob").ok());
  own.roles = secure::Roles(Role::kWatch) | Role::kDirect;
  EXPECT_THAT(Issue(Role::kWatch).status().what(), HasSubstr("role operate is needed"));
  EXPECT_EQ(issuer.Issue(Access::Everything(), {.roles = Role::kWatch, .seconds = 1}, now)
                .status()
                .code(),
            StatusCode::kUnsupported)
      << "an open daemon gives none to everybody";
  EXPECT_EQ(metrics.Get(Counter::kTokensMade), 2u);
}

TEST_F(TokenIssuerTest, ATokenForEveryServerMakesOnesForASingleServer) {
  const auto issue = [this](const std::string& audience) {
    return issuer.Issue(
        Maker(), {.roles = Role::kWatch, .subjects = {}, .seconds = 60, .audience = audience}, now);
  };
  EXPECT_TRUE(issue("a").ok()) << "its own";
  EXPECT_EQ(issue("b").status().where(), "audience");
  own.audience.clear();
  const auto issued = issue("b");
  ASSERT_TRUE(issued.ok()) << issued.status().ToString();
  EXPECT_FALSE(gate.Admit(issued->text, /*shielded=*/true, now).ok()) << "it is not for this one";
}

TEST_F(TokenIssuerTest, NoTokenOutlivesItsKey) {
  secure::KeyRing short_lived;
  key_id = *short_lived.AddNew(kIssuerNow, kIssuerNow + 30, secure::SystemRandom());
  gate.SetKeys(short_lived);
  EXPECT_EQ(Issue(Role::kWatch, {}, 31).status().code(), StatusCode::kUnavailable);
  EXPECT_TRUE(Issue(Role::kWatch, {}, 30).ok());
  gate.SetKeys({});
  EXPECT_EQ(Issue(Role::kWatch, {}, 1).status().code(), StatusCode::kUnavailable);
}

// Otherwise whoever holds a token of a leaked key could move to the next key before it is retired.
TEST_F(TokenIssuerTest, ANewTokenHasTheKeyOfItsMaker) {
  ASSERT_TRUE(ring.AddNew(kIssuerNow + 1, kIssuerNow + 20'000, secure::SystemRandom()).ok());
  gate.SetKeys(ring);
  const auto issued = Issue(Role::kWatch);
  ASSERT_TRUE(issued.ok()) << issued.status().ToString();
  const auto access = gate.Admit(issued->text, /*shielded=*/true, now);
  ASSERT_TRUE(access.ok()) << access.status().ToString();
  EXPECT_EQ(access->key_id(), key_id);
}

TEST_F(TokenIssuerTest, TheRateIsLimited) {
  std::uint32_t made = 0;
  while (Issue(Role::kWatch).ok()) ++made;
  EXPECT_EQ(made, TokenIssuer::kPerSecond);
  EXPECT_EQ(Issue(Role::kWatch).status().code(), StatusCode::kLimit);
  now += std::chrono::seconds(1);
  EXPECT_TRUE(Issue(Role::kWatch).ok());
}

TEST(TokenSubjects, GlobsAreWithinOthersOnlyIfThatIsCertain) {
  for (const char* inner : {"a", "a*", "a*,b", " b ", "", "?"}) EXPECT_TRUE(IsWithin(inner, "*"));
  EXPECT_TRUE(IsWithin("a*, b", "b,a*"));
  EXPECT_TRUE(IsWithin("stage-ann", "stage-*"));
  EXPECT_FALSE(IsWithin("stage-*", "stage-?"));
  EXPECT_FALSE(IsWithin("*", "a*,b*"));
  EXPECT_FALSE(IsWithin("a,c", "a,b"));
  EXPECT_FALSE(IsWithin("**", "a*"));
}

}  // namespace
}  // namespace furrow::server
