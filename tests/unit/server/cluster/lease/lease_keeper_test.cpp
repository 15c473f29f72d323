// SPDX-License-Identifier: Apache-2.0
#include "server/cluster/lease/lease_keeper.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

using std::chrono::milliseconds;

constexpr std::int64_t kKeeperUnixMs = 1'700'000'000'000;

// One node and the store as it sees it. The clock of the node and of the system go together.
class LeaseKeeperTest : public ::testing::Test {
 protected:
  explicit LeaseKeeperTest(bool strict = false) : keeper_("a", 7, strict) {}

  void List() { keeper_.OnListing({incarnation_, entries_}, now_); }
  std::vector<LeaseWrite> Tick() {
    return keeper_.Tick(now_, kKeeperUnixMs + now_ / milliseconds(1));
  }
  void Freeze(Time time) {
    now_ += time;
    keeper_.OnPause(time, now_);
  }
  // Lets the time pass in steps, without writes that the store would answer.
  void Pass(Time time) {
    for (const Time end = now_ + time; now_ < end;) {
      now_ += milliseconds(100);
      (void)Tick();
    }
  }
  // The store is reachable and known for long enough.
  void Settle() {
    keeper_.OnReachable(true, now_);
    List();
    Pass(kLeaseTtl);
  }
  void Done(const LeaseWrite& write) {
    std::erase_if(entries_, [&](const LeaseEntry& each) { return each.subject == write.subject; });
    entries_.push_back({write.subject, write.lease, ++revision_});
    keeper_.OnWritten(write.subject, write.id, WriteResult::kDone, revision_, now_);
  }
  // Takes the lease of "ada" and returns its epoch.
  std::uint64_t Take() {
    keeper_.Want("ada");
    const auto writes = Tick();
    EXPECT_EQ(writes.size(), 1u);
    if (writes.empty()) return 0;
    Done(writes[0]);
    List();
    return writes[0].lease.epoch;
  }
  [[nodiscard]] bool Serves() const { return keeper_.ServingOf("ada", now_).has_value(); }

  LeaseKeeper keeper_;
  Time now_ = std::chrono::seconds(100);
  std::uint64_t incarnation_ = 1;
  Revision revision_ = 10;
  std::vector<LeaseEntry> entries_;
};

class StrictLeaseKeeperTest : public LeaseKeeperTest {
 protected:
  StrictLeaseKeeperTest() : LeaseKeeperTest(true) {}
};

TEST_F(LeaseKeeperTest, AnHeirGetsTheLeaseInTheNextEpochAndNobodyElse) {
  Settle();
  const std::uint64_t epoch = Take();
  keeper_.HandOver("ada", "b", 8);
  EXPECT_FALSE(Serves());
  auto writes = Tick();
  ASSERT_EQ(writes.size(), 1u);
  EXPECT_EQ(writes[0].lease.node, "b");
  EXPECT_EQ(writes[0].lease.run, 8u);
  EXPECT_EQ(writes[0].lease.epoch, epoch + 1);
  EXPECT_EQ(writes[0].expected, revision_);
  EXPECT_TRUE(keeper_.holds_any());
  Done(writes[0]);
  EXPECT_FALSE(keeper_.holds_any());
  EXPECT_EQ(keeper_.HolderOf("ada", now_), "b");
}

TEST_F(LeaseKeeperTest, AHandOverIsRepeatedUntilItIsWritten) {
  Settle();
  (void)Take();
  keeper_.HandOver("ada", "b", 8);
  auto writes = Tick();
  ASSERT_EQ(writes.size(), 1u);
  keeper_.OnWritten("ada", writes[0].id, WriteResult::kUnknown, 0, now_);
  keeper_.Release("ada");  // changes nothing
  List();
  writes = Tick();
  ASSERT_EQ(writes.size(), 1u);
  EXPECT_EQ(writes[0].lease.node, "b");
}

TEST_F(LeaseKeeperTest, AnHeirServesAsSoonAsItHasWrittenTheLease) {
  Settle();
  keeper_.Want("ada");
  entries_ = {{"ada", {.node = "b", .run = 8, .epoch = 5, .deadline_ms = 0}, ++revision_}};
  keeper_.OnEntry(entries_[0], now_);
  EXPECT_TRUE(Tick().empty()) << "the other node holds it";
  // The other node names this one.
  entries_ = {{"ada", {.node = "a", .run = 7, .epoch = 6, .deadline_ms = 0}, ++revision_}};
  keeper_.OnEntry(entries_[0], now_);
  EXPECT_FALSE(Serves()) << "nobody knows how old the record is";
  const auto writes = Tick();
  ASSERT_EQ(writes.size(), 1u);
  EXPECT_EQ(writes[0].expected, revision_);
  EXPECT_GT(writes[0].lease.epoch, 6u);
  Done(writes[0]);
  EXPECT_TRUE(Serves()) << "without a listing";
}

TEST_F(LeaseKeeperTest, AnInheritanceOfAStoreThatWasEmptiedIsNone) {
  Settle();
  keeper_.Want("ada");
  entries_ = {{"ada", {.node = "a", .run = 7, .epoch = 6, .deadline_ms = 0}, ++revision_}};
  keeper_.OnEntry(entries_[0], now_);
  const auto writes = Tick();
  ASSERT_EQ(writes.size(), 1u);
  incarnation_ = 2;
  entries_.clear();
  List();
  keeper_.OnWritten("ada", writes[0].id, WriteResult::kDone, ++revision_, now_);
  EXPECT_FALSE(Serves());
}

TEST_F(LeaseKeeperTest, TakesNothingBeforeTheStoreIsKnownForTheTimeOfALease) {
  keeper_.Want("ada");
  keeper_.OnReachable(true, now_);
  EXPECT_TRUE(Tick().empty());
  List();
  EXPECT_TRUE(Tick().empty());
  const Time end = now_ + kLeaseTtl;
  while (now_ < end - milliseconds(1)) {
    now_ = std::min(now_ + milliseconds(500), end - milliseconds(1));
    EXPECT_TRUE(Tick().empty());
  }
  now_ = end;
  const auto writes = Tick();
  ASSERT_EQ(writes.size(), 1u);
  EXPECT_EQ(writes[0].expected, 0u);
  EXPECT_EQ(writes[0].lease.node, "a");
  EXPECT_GE(writes[0].lease.epoch, static_cast<std::uint64_t>(kKeeperUnixMs));
}

TEST_F(LeaseKeeperTest, ServesOnlyWhatAListingConfirms) {
  Settle();
  keeper_.Want("ada");
  Done(Tick().at(0));
  EXPECT_FALSE(Serves());
  EXPECT_TRUE(keeper_.needs_listing());
  List();
  EXPECT_TRUE(Serves());
  EXPECT_FALSE(keeper_.needs_listing());
}

TEST_F(LeaseKeeperTest, StopsByItselfAndCountsFromTheMomentOfSending) {
  Settle();
  keeper_.Want("ada");
  const auto write = Tick().at(0);
  const Time sent = now_;
  now_ += milliseconds(600);  // the way of the answer
  Done(write);
  List();
  EXPECT_EQ(keeper_.ServingOf("ada", now_)->until, sent + kLeaseStop);
  now_ = sent + kLeaseStop - milliseconds(1);
  EXPECT_TRUE(Serves());
  now_ += milliseconds(1);
  EXPECT_FALSE(Serves());
}

TEST_F(LeaseKeeperTest, RenewsInTheSameEpoch) {
  Settle();
  const std::uint64_t epoch = Take();
  now_ += kLeaseRenewal;
  const auto writes = Tick();
  ASSERT_EQ(writes.size(), 1u);
  EXPECT_EQ(writes[0].lease.epoch, epoch);
  EXPECT_EQ(writes[0].expected, revision_);
  Done(writes[0]);
  EXPECT_EQ(keeper_.ServingOf("ada", now_)->until, now_ + kLeaseStop);
}

TEST_F(LeaseKeeperTest, TakesOverWhatWasNotRenewedAndGoesAboveItsEpoch) {
  const std::uint64_t ahead =
      kKeeperUnixMs + kMaxEpochAhead;  // the clock of the other node is far ahead
  entries_ = {{"ada", {.node = "b", .run = 1, .epoch = ahead, .deadline_ms = 0}, 5}};
  Settle();
  EXPECT_EQ(keeper_.HolderOf("ada", now_ - milliseconds(1)), "b");
  keeper_.Want("ada");
  const auto writes = Tick();
  ASSERT_EQ(writes.size(), 1u);
  EXPECT_EQ(writes[0].expected, 5u);
  EXPECT_EQ(writes[0].lease.epoch, ahead + 1);
}

TEST_F(LeaseKeeperTest, LeavesALeaseAloneThatIsRenewed) {
  Settle();
  keeper_.Want("ada");
  for (int second = 0; second < 10; ++second) {
    entries_ = {{"ada", {.node = "b", .run = 1, .epoch = 5, .deadline_ms = 0}, ++revision_}};
    List();
    now_ += kLeaseRenewal;
    EXPECT_TRUE(Tick().empty());
    EXPECT_EQ(keeper_.HolderOf("ada", now_), "b");
  }
}

TEST_F(LeaseKeeperTest, AListingThatNamesAnotherHolderEndsTheLease) {
  Settle();
  (void)Take();
  entries_ = {{"ada", {.node = "b", .run = 1, .epoch = kMaxEpoch, .deadline_ms = 0}, 99}};
  List();
  EXPECT_FALSE(Serves());
  EXPECT_EQ(keeper_.HolderOf("ada", now_), "b");
}

// A record cannot use up all epochs.
TEST_F(LeaseKeeperTest, AnAbsurdEpochDoesNotEndPlacement) {
  entries_ = {{"eve", {.node = {}, .run = 0, .epoch = kMaxEpoch, .deadline_ms = 0}, 5}};
  Settle();
  const std::uint64_t epoch = Take();
  EXPECT_GT(epoch, static_cast<std::uint64_t>(kKeeperUnixMs));
  EXPECT_LT(epoch, kLeastClock);
  EXPECT_TRUE(Serves());
}

TEST_F(LeaseKeeperTest, ReleasingAllTakesNothingThatWasOnlyWanted) {
  Settle();
  (void)Take();
  keeper_.Want("bob");
  keeper_.ReleaseAll();
  const auto writes = Tick();
  ASSERT_EQ(writes.size(), 1u);
  EXPECT_EQ(writes[0].subject, "ada");
  EXPECT_EQ(writes[0].lease.node, "");
  Done(writes[0]);
  EXPECT_TRUE(Tick().empty());
  EXPECT_FALSE(keeper_.holds_any());
}

TEST_F(LeaseKeeperTest, WritesItsLeaseAgainIntoAnEmptiedStore) {
  Settle();
  const std::uint64_t epoch = Take();
  entries_.clear();
  ++incarnation_;
  List();
  EXPECT_TRUE(Serves());
  now_ += kLeaseRenewal;
  const auto writes = Tick();
  ASSERT_EQ(writes.size(), 1u);
  EXPECT_EQ(writes[0].expected, 0u);
  EXPECT_EQ(writes[0].lease.epoch, epoch);
}

TEST_F(LeaseKeeperTest, ARefusedWriteWaitsForAListing) {
  Settle();
  keeper_.Want("ada");
  const LeaseWrite write = Tick().at(0);
  keeper_.OnWritten(write.subject, write.id, WriteResult::kRefused, 0, now_);
  now_ += kLeaseRenewal;
  EXPECT_TRUE(Tick().empty());
  List();
  EXPECT_EQ(Tick().size(), 1u);
}

TEST_F(LeaseKeeperTest, ReleasesAndKeepsTheEpochInTheStore) {
  Settle();
  const std::uint64_t epoch = Take();
  keeper_.Release("ada");
  EXPECT_FALSE(Serves());
  const auto writes = Tick();
  ASSERT_EQ(writes.size(), 1u);
  EXPECT_EQ(writes[0].lease.node, "");
  EXPECT_EQ(writes[0].lease.epoch, epoch);
  Done(writes[0]);
  EXPECT_TRUE(Tick().empty());
  // The next holder need not wait.
  EXPECT_GT(Take(), epoch);
}

TEST_F(LeaseKeeperTest, ServesOnWithoutTheStoreButTakesNothing) {
  Settle();
  const std::uint64_t epoch = Take();
  keeper_.OnReachable(false, now_);
  keeper_.Want("bob");
  for (int step = 0; step < 600; ++step) {
    Pass(milliseconds(100));
    ASSERT_GE(keeper_.ServingOf("ada", now_)->until, now_ + milliseconds(500)) << step;
  }
  EXPECT_EQ(keeper_.ServingOf("ada", now_)->epoch, epoch);
  EXPECT_FALSE(keeper_.ServingOf("bob", now_));
  // The others were not late either: the store was gone for them, too.
  keeper_.OnReachable(true, now_);
  List();
  EXPECT_TRUE(Serves());
}

TEST_F(LeaseKeeperTest, AfterAFreezeALostStoreProlongsNothing) {
  Settle();
  (void)Take();
  Freeze(std::chrono::seconds(5));
  keeper_.OnReachable(false, now_);
  (void)Tick();
  EXPECT_FALSE(Serves());
}

// The node ran, and its calls to the store waited for an answer that never came.
TEST_F(LeaseKeeperTest, ALeaseOutlivesALateNoticeThatTheStoreIsGone) {
  Settle();
  (void)Take();
  now_ += std::chrono::seconds(3);
  keeper_.OnPause(milliseconds(100), now_);
  keeper_.OnReachable(false, now_);
  (void)Tick();
  EXPECT_TRUE(Serves());
}

// The store may have been emptied twice meanwhile, and another node's record may have the revision
// that this one would replace.
TEST_F(LeaseKeeperTest, AfterAFreezeAListingComesBeforeTheNextWrite) {
  Settle();
  const std::uint64_t epoch = Take();
  Freeze(std::chrono::seconds(5));
  EXPECT_TRUE(Tick().empty());
  EXPECT_TRUE(keeper_.needs_listing());
  ++incarnation_;
  entries_[0].lease = {.node = "b", .run = 8, .epoch = epoch + 1, .deadline_ms = kKeeperUnixMs};
  List();
  EXPECT_TRUE(Tick().empty());
  EXPECT_EQ(keeper_.HolderOf("ada", now_), "b");
}

TEST_F(LeaseKeeperTest, AfterAFreezeAListingComesBeforeANewSubjectIsTaken) {
  Settle();
  entries_.push_back({"ada", {.node = {}, .run = 0, .epoch = 5, .deadline_ms = 0}, ++revision_});
  List();
  Freeze(std::chrono::seconds(5));
  (void)Tick();
  keeper_.Want("ada");
  EXPECT_TRUE(Tick().empty());
  List();
  EXPECT_EQ(Tick().size(), 1u);
}

TEST_F(LeaseKeeperTest, AfterAFreezeALeaseIsGivenBackOnceTheStoreIsListed) {
  Settle();
  (void)Take();
  Freeze(std::chrono::seconds(5));
  keeper_.Release("ada");
  EXPECT_TRUE(Tick().empty());
  EXPECT_TRUE(keeper_.holds_any());
  List();
  const auto writes = Tick();
  ASSERT_EQ(writes.size(), 1u);
  EXPECT_EQ(writes[0].lease.node, "");
}

TEST_F(LeaseKeeperTest, TheAnswerOfAnEmptiedStoreHidesNoRecord) {
  Settle();
  const std::uint64_t epoch = Take();
  std::vector<LeaseWrite> writes;
  for (const Time end = now_ + kLeaseTtl; writes.empty() && now_ < end;) {
    now_ += milliseconds(100);
    writes = Tick();
  }
  ASSERT_EQ(writes.size(), 1u);
  ++incarnation_;
  entries_.clear();
  List();
  // The store confirmed it before it was emptied, with a higher revision than the next record has.
  keeper_.OnWritten("ada", writes[0].id, WriteResult::kDone, revision_ + 1, now_);
  entries_ = {
      {"ada", {.node = "b", .run = 8, .epoch = epoch + 1, .deadline_ms = kKeeperUnixMs}, 1}};
  List();
  EXPECT_EQ(keeper_.HolderOf("ada", now_), "b");
  EXPECT_FALSE(Serves());
}

// Without the store, nobody can have taken over meanwhile that could not do so at any time.
TEST_F(LeaseKeeperTest, WithoutTheStoreALeaseOutlivesAFreeze) {
  Settle();
  (void)Take();
  keeper_.OnReachable(false, now_);
  Pass(std::chrono::seconds(10));
  now_ += std::chrono::seconds(5);
  EXPECT_FALSE(Serves()) << "before the node has looked";
  (void)Tick();
  EXPECT_TRUE(Serves());
}

TEST_F(StrictLeaseKeeperTest, StopsWithoutTheStore) {
  Settle();
  (void)Take();
  keeper_.OnReachable(false, now_);
  EXPECT_TRUE(Serves());
  Pass(kLeaseStop);
  EXPECT_FALSE(Serves());
}

}  // namespace
}  // namespace furrow::server
