// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/handshake/cookie.h"

#include <set>

#include <gtest/gtest.h>

#include "tests/unit/protocol/secure/secure_testing.h"

namespace furrow::protocol::secure {
namespace {

using Purpose = CookieMaker::Purpose;
constexpr std::int64_t kSlot = CookieMaker::kSlotMicroseconds;

class Cookies : public ::testing::Test {
 protected:
  Cookies() { random_.Fill(context_); }
  bool Check(const Cookie& cookie, std::int64_t now_us, const PeerAddress& from = test::kHome,
             Purpose purpose = Purpose::kInitiation) {
    return maker_.Check(cookie, purpose, from, context_, now_us);
  }

  test::RepeatableRandom random_;
  CookieMaker maker_{random_};
  std::array<std::uint8_t, CookieMaker::kContextBytes> context_;
};

TEST_F(Cookies, HoldForTheirSlotAndTheNext) {
  const Cookie cookie = maker_.Make(Purpose::kInitiation, test::kHome, context_, 5 * kSlot);
  EXPECT_TRUE(Check(cookie, 5 * kSlot));
  EXPECT_TRUE(Check(cookie, 6 * kSlot - 1));
  EXPECT_TRUE(Check(cookie, 7 * kSlot - 1));
  EXPECT_FALSE(Check(cookie, 7 * kSlot));
  EXPECT_FALSE(Check(cookie, 700 * kSlot));
}

TEST_F(Cookies, BelongToAddressPortContextAndPurpose) {
  const Cookie cookie = maker_.Make(Purpose::kInitiation, test::kHome, context_, 0);
  EXPECT_TRUE(Check(cookie, 0));
  EXPECT_FALSE(Check(cookie, 0, test::kSameHost));
  EXPECT_FALSE(Check(cookie, 0, test::kAway));
  EXPECT_FALSE(Check(cookie, 0, test::kHome, Purpose::kPath));
  context_[23] ^= 1;
  EXPECT_FALSE(Check(cookie, 0));
}

TEST_F(Cookies, RefuseEveryFlippedBitAndZero) {
  const Cookie cookie = maker_.Make(Purpose::kInitiation, test::kHome, context_, 9 * kSlot);
  for (std::size_t bit = 0; bit < kCookieBytes * 8; ++bit) {
    Cookie changed = cookie;
    changed[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
    EXPECT_FALSE(Check(changed, 9 * kSlot)) << bit;
  }
  EXPECT_FALSE(Check(Cookie{}, 0));
}

// After a pause, the key of the slot before is one that nobody has used.
TEST_F(Cookies, AfterAPauseOldKeysAreGone) {
  const Cookie cookie = maker_.Make(Purpose::kInitiation, test::kHome, context_, 0);
  Cookie moved = cookie;
  moved[0] = 9;  // claims to be of slot 9
  EXPECT_FALSE(Check(moved, 10 * kSlot));
}

TEST_F(Cookies, EveryMakerAndEverySlotHasItsOwnKey) {
  std::set<Cookie> cookies;
  for (int slot = 0; slot < 10; ++slot) {
    cookies.insert(maker_.Make(Purpose::kInitiation, test::kHome, context_, slot * kSlot));
  }
  CookieMaker restarted(random_);
  const Cookie other = restarted.Make(Purpose::kInitiation, test::kHome, context_, 9 * kSlot);
  EXPECT_FALSE(Check(other, 9 * kSlot));
  cookies.insert(other);
  EXPECT_EQ(cookies.size(), 11u);
}

}  // namespace
}  // namespace furrow::protocol::secure
