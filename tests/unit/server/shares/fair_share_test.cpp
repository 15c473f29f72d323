// SPDX-License-Identifier: Apache-2.0
#include "server/shares/fair_share.h"

#include <string>

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

// Takes all places that the host gets.
int TakeAll(FairShare& share, const std::string& host) {
  int taken = 0;
  while (share.Enter(host)) ++taken;
  return taken;
}

TEST(FairShare, EachHostGetsHalfOfWhatIsLeft) {
  FairShare share(256);
  EXPECT_EQ(TakeAll(share, "a"), 128);
  EXPECT_EQ(TakeAll(share, "b"), 64);
  EXPECT_EQ(TakeAll(share, "a"), 0);
  EXPECT_EQ(share.taken(), 192u);
}

TEST(FairShare, SeveralPlacesAreTakenAsIfOneAfterTheOther) {
  for (std::size_t before = 0; before < 12; ++before) {
    for (std::size_t count = 1; count < 12; ++count) {
      FairShare at_once(20);
      FairShare in_turn(20);
      std::size_t entered = 0;
      for (FairShare* share : {&at_once, &in_turn}) {
        EXPECT_TRUE(share->Enter("other", 3));
        entered = 0;
        while (entered < before && share->Enter("a")) ++entered;
      }
      bool all = true;
      for (std::size_t i = 0; i < count; ++i) all = all && in_turn.Enter("a");
      EXPECT_EQ(at_once.Enter("a", count), all) << before << " " << count;
      EXPECT_EQ(at_once.held("a"), entered + (all ? count : 0));
      if (at_once.held("a") > 0) at_once.Leave("a", at_once.held("a"));
      EXPECT_EQ(at_once.taken(), 3u);
    }
  }
}

TEST(FairShare, AFewPlacesAreForAnybody) {
  FairShare one(1);
  EXPECT_TRUE(one.Enter("a"));
  EXPECT_FALSE(one.Enter("b")) << "there is no second place";
  FairShare none(0);
  EXPECT_FALSE(none.Enter("a"));
}

TEST(FairShare, ThereIsRoomForANewcomer) {
  FairShare share(256);
  for (int host = 0; host < 8; ++host) {
    ASSERT_TRUE(share.Enter("newcomer")) << host << " greedy hosts";
    share.Leave("newcomer");
    EXPECT_GT(TakeAll(share, "greedy " + std::to_string(host)), 0) << host;
  }
}

TEST(FairShare, APlaceThatIsGivenBackIsFree) {
  FairShare share(4);
  EXPECT_EQ(TakeAll(share, "a"), 2);
  share.Leave("a");
  EXPECT_TRUE(share.Enter("a"));
  for (int i = 0; i < 2; ++i) share.Leave("a");
  EXPECT_EQ(share.taken(), 0u);
  EXPECT_EQ(TakeAll(share, "b"), 2);
}

TEST(FairShare, FewerPlacesTakeNoneAway) {
  FairShare share(8);
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(share.Enter("a"));
  share.SetPlaces(2);
  EXPECT_FALSE(share.HasRoomFor("b"));
  EXPECT_FALSE(share.Enter("a"));
  EXPECT_EQ(share.held("a"), 4u);
  for (int i = 0; i < 3; ++i) share.Leave("a");
  EXPECT_TRUE(share.Enter("b")) << "one of two is taken";
  share.SetPlaces(8);
  EXPECT_TRUE(share.Enter("a"));
}

}  // namespace
}  // namespace furrow::server
