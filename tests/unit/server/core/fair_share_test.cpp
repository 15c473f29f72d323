// SPDX-License-Identifier: Apache-2.0
#include "server/core/fair_share.h"

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
