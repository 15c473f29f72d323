// SPDX-License-Identifier: Apache-2.0
#include "server/session/subscriptions/subscription_table.h"

#include <cstdint>
#include <memory>
#include <new>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/allocation_counter.h"
#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

using testing::ElementsAre;

class SubscriptionTableTest : public testing::Test {
 protected:
  void SetUp() override { peer.link = &link; }
  Subscription& Add(std::uint32_t sequence) {
    return table.Add(peer, {.session = 7, .sequence = sequence}, std::make_unique<Subscription>());
  }

  FakePeer link;
  Peer peer;
  Subject subject{.id = 5};
  SubscriptionTable table{1'000};
};

TEST_F(SubscriptionTableTest, FindsByUidByIdAndByRequest) {
  Subscription& first = Add(1);
  Subscription& second = Add(2);
  EXPECT_NE(first.id, second.id);
  EXPECT_EQ(peer.num_subscriptions, 2);
  EXPECT_EQ(table.Find(first.uid), &first);
  EXPECT_EQ(table.Find(peer, second.id), &second);
  EXPECT_EQ(table.FindRepeated(peer, {.session = 7, .sequence = 2}), &second);
  EXPECT_EQ(table.FindRepeated(peer, {.session = 8, .sequence = 2}), nullptr);
  EXPECT_EQ(table.Find(Peer{}, second.id), nullptr) << "ids are per peer";
}

TEST_F(SubscriptionTableTest, IdsSkipZeroAndThoseInUse) {
  const std::uint16_t first = Add(1).id;
  peer.last_subscription = 65535;
  EXPECT_EQ(first, 1);
  EXPECT_EQ(Add(2).id, 2);
}

TEST_F(SubscriptionTableTest, LackOfMemoryLeavesEverythingAsItWas) {
  std::uint64_t allowed = 0;
  for (bool failed = true; failed; ++allowed) {
    auto subscription = std::make_unique<Subscription>();
    try {
      const furrow::test::AllocationLimit limit(allowed);
      (void)table.Add(peer, {.session = 7, .sequence = 1}, std::move(subscription));
      failed = false;
    } catch (const std::bad_alloc&) {
      ASSERT_EQ(table.size(), 0u) << allowed;
      ASSERT_EQ(peer.num_subscriptions, 0) << allowed;
      ASSERT_TRUE(table.Of(peer).empty()) << allowed;
      ASSERT_EQ(table.num_places_taken(), 0u) << allowed;
    }
  }
  EXPECT_GT(allowed, 3u);
  EXPECT_EQ(table.size(), 1u);
  EXPECT_EQ(table.num_places_taken(), 1u);
}

TEST_F(SubscriptionTableTest, ErasingGivesThePlaceBack) {
  Subscription& first = Add(1);
  (void)Add(2);
  table.Erase(first);
  EXPECT_EQ(table.num_places_taken(), 1u);
}

TEST_F(SubscriptionTableTest, AttachedSubscriptionsAreListedOnceInOrder) {
  Subscription& first = Add(1);
  Subscription& second = Add(2);
  EXPECT_TRUE(subject.subscriptions.empty());
  table.Attach(second, subject);
  table.Attach(first, subject);
  table.Attach(second, subject);
  EXPECT_THAT(subject.subscriptions, ElementsAre(&second, &first));
}

TEST_F(SubscriptionTableTest, ErasingDetachesAndDropsQueuedFrames) {
  Subscription& first = Add(1);
  Subscription& second = Add(2);
  table.Attach(first, subject);
  table.Attach(second, subject);
  const std::uint64_t uid = first.uid;
  table.Erase(first);
  EXPECT_THAT(link.dropped_keys, ElementsAre(uid));
  EXPECT_THAT(subject.subscriptions, ElementsAre(&second));
  EXPECT_EQ(peer.num_subscriptions, 1);
  EXPECT_EQ(table.Find(uid), nullptr);
}

TEST_F(SubscriptionTableTest, DetachingASubjectUnbindsItsSubscriptions) {
  Subscription& only = Add(1);
  table.Attach(only, subject);
  EXPECT_THAT(table.DetachAll(subject), ElementsAre(&only));
  EXPECT_EQ(only.subject, nullptr);
  EXPECT_TRUE(table.DetachAll(subject).empty());
  EXPECT_EQ(table.size(), 1u);
}

TEST_F(SubscriptionTableTest, SelectKeepsTheOrderOfRequests) {
  std::vector<Subscription*> all;
  for (std::uint32_t i = 0; i < 50; ++i) all.push_back(&Add(i));
  EXPECT_EQ(table.Select([](const Subscription&) { return true; }), all);
  EXPECT_TRUE(table.Select([](const Subscription&) { return false; }).empty());
}

}  // namespace
}  // namespace furrow::server
