// SPDX-License-Identifier: Apache-2.0
#include "server/cluster/store/transits.h"

#include <chrono>
#include <string>

#include <gtest/gtest.h>

#include "server/cluster/coordinator.h"

namespace furrow::server {
namespace {

constexpr Time kNow = std::chrono::seconds(100);
constexpr Time kEnd = kNow + Coordinator::kExpected;

bool IsNowhere(const std::string& /*subject*/) { return false; }

TEST(Transits, ASubjectIsExpectedForItsTime) {
  Transits transits;
  EXPECT_FALSE(transits.ExpectsAny(kNow));
  transits.Expect("ada", kNow);
  EXPECT_TRUE(transits.IsExpected("ada", kEnd - Time{1}));
  EXPECT_FALSE(transits.IsExpected("ada", kEnd));
  EXPECT_FALSE(transits.IsExpected("bob", kNow));
  EXPECT_TRUE(transits.ExpectsAny(kEnd - Time{1}));
  EXPECT_FALSE(transits.ExpectsAny(kEnd));
  transits.Expect("ada", kEnd);
  transits.ForgetExpected("ada");
  EXPECT_FALSE(transits.IsExpected("ada", kEnd));
}

TEST(Transits, CountsWhatTakesAPlace) {
  Transits transits;
  transits.Expect("ada", kNow);
  transits.Expect("bob", kNow);
  transits.Expect("cyd", kNow + Time{1});
  EXPECT_EQ(transits.CountExpected("", IsNowhere, kNow), 3u);
  EXPECT_EQ(transits.CountExpected("bob", IsNowhere, kNow), 2u) << "the one that asks";
  const auto is_ada = [](const std::string& subject) { return subject == "ada"; };
  EXPECT_EQ(transits.CountExpected("bob", is_ada, kNow), 1u) << "the one that is here already";
  EXPECT_EQ(transits.CountExpected("", IsNowhere, kEnd), 1u) << "those that came in time";
}

TEST(Transits, AnHeirIsKnownUntilTheStoreShowsIt) {
  Transits transits;
  const NodeAddress b{"b", "host-b", 1, 2, 3};
  transits.Give("ada", b, kNow);
  EXPECT_EQ(transits.HeirOf("ada", kEnd - Time{1}), b);
  EXPECT_EQ(transits.HeirOf("ada", kEnd), std::nullopt);
  EXPECT_EQ(transits.HeirOf("bob", kNow), std::nullopt);
  transits.Give("bob", b, kEnd);
  EXPECT_EQ(transits.NumGivenTo("b"), 2) << "also those that are forgotten";
  EXPECT_EQ(transits.NumGivenTo("c"), 0);
}

}  // namespace
}  // namespace furrow::server
