// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/token/connect_token.h"

#include <gtest/gtest.h>

#include "tests/unit/protocol/secure/secure_testing.h"

namespace furrow::protocol::secure {
namespace {

constexpr std::uint32_t kId = 0x7f3a0c21;
constexpr std::uint64_t kExpires = 1'900'000'000;

class ConnectToken : public ::testing::Test {
 protected:
  [[nodiscard]] ClientToken Make(const Grant& grant) {
    return *MakeToken(kId, key_, kExpires, grant, random_);
  }
  // Seals any private part, as an issuer with a fault would.
  [[nodiscard]] TokenBytes Sealed(std::size_t at, std::uint8_t value) {
    ClientToken token = Make(test::WatchGrant());
    TokenHead head;
    (void)ReadTokenHead(token.bytes, head);
    const std::span<std::uint8_t, kTokenBytes> bytes(token.bytes);
    const auto part = bytes.subspan<kTokenPublicBytes, kTokenPrivateBytes>();
    EXPECT_TRUE(OpenWithNonce(key_, head.nonce, bytes.first<kTokenPublicBytes>(), part,
                              bytes.last<kTagBytes>()));
    part[at] = value;
    SealWithNonce(key_, head.nonce, bytes.first<kTokenPublicBytes>(), part,
                  bytes.last<kTagBytes>());
    return token.bytes;
  }

  test::RepeatableRandom random_;
  Key key_ = random_.MakeKey();
};

TEST_F(ConnectToken, RoundTrips) {
  Grant grant;
  grant.client_id = ~0ULL;
  grant.roles = Roles(Role::kPublish) | Role::kOperate;
  grant.packets_per_second = 4'000;
  grant.subjects = std::string(kMaxSubjectsBytes, 's');
  grant.audience = std::string(kMaxAudienceBytes, 'a');
  const ClientToken token = Make(grant);
  TokenHead head;
  ASSERT_EQ(ReadTokenHead(token.bytes, head), TokenStatus::kOk);
  EXPECT_EQ(head.key_id, kId);
  EXPECT_EQ(head.expires, kExpires);
  OpenedToken opened;
  ASSERT_EQ(OpenToken(token.bytes, key_, opened), TokenStatus::kOk);
  EXPECT_EQ(opened.grant.client_id, grant.client_id);
  EXPECT_EQ(opened.grant.roles, grant.roles);
  EXPECT_EQ(opened.grant.packets_per_second, 4'000u);
  EXPECT_EQ(opened.grant.subjects, grant.subjects);
  EXPECT_EQ(opened.grant.audience, grant.audience);
  EXPECT_TRUE(EqualInConstantTime(opened.key.bytes(), token.key.bytes()));
}

TEST_F(ConnectToken, RefusesEveryFlippedBit) {
  const ClientToken token = Make(test::WatchGrant());
  for (std::size_t bit = 0; bit < kTokenBytes * 8; ++bit) {
    TokenBytes bytes = token.bytes;
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
    OpenedToken opened;
    ASSERT_NE(OpenToken(bytes, key_, opened), TokenStatus::kOk) << bit;
  }
}

TEST_F(ConnectToken, RefusesAnotherKey) {
  const ClientToken token = Make(test::WatchGrant());
  OpenedToken opened;
  EXPECT_EQ(OpenToken(token.bytes, random_.MakeKey(), opened), TokenStatus::kNotAuthentic);
}

TEST_F(ConnectToken, NamesWhatIsWrongInThePublicPart) {
  const ClientToken token = Make(test::WatchGrant());
  TokenHead head;
  TokenBytes bytes = token.bytes;
  bytes[3] ^= 1;
  EXPECT_EQ(ReadTokenHead(bytes, head), TokenStatus::kBadMagic);
  bytes = token.bytes;
  bytes[4] = 2;
  EXPECT_EQ(ReadTokenHead(bytes, head), TokenStatus::kBadVersion);
  for (const std::size_t at : {5, 6, 7}) {
    bytes = token.bytes;
    bytes[at] = 1;
    EXPECT_EQ(ReadTokenHead(bytes, head), TokenStatus::kBadReserved);
  }
}

// A seal proves who made a token, not that its content makes sense.
TEST_F(ConnectToken, ChecksTheContentBehindTheSeal) {
  OpenedToken opened;
  EXPECT_EQ(OpenToken(Sealed(0, 78), key_, opened), TokenStatus::kOk);
  EXPECT_EQ(OpenToken(Sealed(40, 0), key_, opened), TokenStatus::kBadRoles);
  EXPECT_EQ(OpenToken(Sealed(40, 16), key_, opened), TokenStatus::kBadRoles);
  EXPECT_EQ(OpenToken(Sealed(41, 1), key_, opened), TokenStatus::kBadRoles);
  EXPECT_EQ(OpenToken(Sealed(42, 1), key_, opened), TokenStatus::kBadReserved);
  EXPECT_EQ(OpenToken(Sealed(43, 1), key_, opened), TokenStatus::kBadReserved);
  EXPECT_EQ(OpenToken(Sealed(48, 48), key_, opened), TokenStatus::kBadAudience);
  EXPECT_EQ(OpenToken(Sealed(48, 1), key_, opened), TokenStatus::kBadAudience);    // a zero byte
  EXPECT_EQ(OpenToken(Sealed(95, 'x'), key_, opened), TokenStatus::kBadAudience);  // after the end
  EXPECT_EQ(OpenToken(Sealed(96, 96), key_, opened), TokenStatus::kBadSubjects);
  EXPECT_EQ(OpenToken(Sealed(97, 0x80), key_, opened), TokenStatus::kBadSubjects);  // not UTF-8
  EXPECT_EQ(OpenToken(Sealed(97, '\n'), key_, opened), TokenStatus::kBadSubjects);
  EXPECT_EQ(OpenToken(Sealed(191, 'x'), key_, opened), TokenStatus::kBadSubjects);
}

TEST_F(ConnectToken, MakesNoBadToken) {
  const auto status_of = [this](Grant grant) {
    return MakeToken(kId, key_, kExpires, grant, random_).status();
  };
  Grant grant = test::WatchGrant();
  EXPECT_TRUE(status_of(grant).ok());
  grant.roles = Roles();
  EXPECT_EQ(status_of(grant).what(), "a token needs at least one role");
  grant = test::WatchGrant();
  grant.subjects = "";
  EXPECT_EQ(status_of(grant).what(), "the pattern of subjects is empty");
  grant.subjects = std::string(kMaxSubjectsBytes + 1, 's');
  EXPECT_EQ(status_of(grant).what(), "the pattern of subjects has 96 bytes; the limit is 95");
  grant.subjects = "a\tb";
  EXPECT_EQ(status_of(grant).code(), StatusCode::kInvalidArgument);
  grant = test::WatchGrant();
  grant.audience = std::string(kMaxAudienceBytes + 1, 's');
  EXPECT_EQ(status_of(grant).what(), "the name of the server has 48 bytes; the limit is 47");
}

TEST_F(ConnectToken, EveryTokenHasItsOwnKeyAndNonce) {
  const ClientToken a = Make(test::WatchGrant());
  const ClientToken b = Make(test::WatchGrant());
  EXPECT_NE(a.bytes, b.bytes);
  EXPECT_FALSE(EqualInConstantTime(a.key.bytes(), b.key.bytes()));
}

TEST(GrantTest, RolesAndPatternDecideTogether) {
  Grant grant = test::WatchGrant();
  EXPECT_TRUE(grant.MayWatch("stage-anna"));
  EXPECT_FALSE(grant.MayWatch("green-room"));
  EXPECT_FALSE(grant.MayPublish("stage-anna"));
  grant.roles = Role::kPublish;
  EXPECT_TRUE(grant.MayPublish("stage-anna"));
  EXPECT_FALSE(grant.MayPublish("green-room"));
  EXPECT_FALSE(grant.MayWatch("stage-anna"));
}

TEST(RolesTest, Text) {
  EXPECT_EQ(ToText(Roles(Role::kOperate) | Role::kPublish), "publish,operate");
  EXPECT_EQ(*ParseRoles("watch,direct"), Roles(Role::kWatch) | Role::kDirect);
  for (const char* text : {"", "watch,", ",watch", "Watch", "watch direct", "admin"}) {
    EXPECT_EQ(ParseRoles(text).status().code(), StatusCode::kInvalidArgument) << text;
  }
  for (std::uint16_t bits = 1; bits <= Roles::kAllBits; ++bits) {
    EXPECT_EQ(ParseRoles(ToText(Roles(bits)))->bits(), bits);
  }
}

}  // namespace
}  // namespace furrow::protocol::secure
