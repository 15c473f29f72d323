// SPDX-License-Identifier: Apache-2.0
#include "server/cluster/store/store_coordinator.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

using std::chrono::milliseconds;

// What all nodes of a test share. The clock goes on only while the nodes wait, so seconds of a
// cluster take moments. No node gets ahead of the others, however busy the computer is.
struct World {
  std::mutex mutex;
  std::map<std::string, StoreRecord> records;
  Revision revision = 0;
  std::uint64_t incarnation = 1;
  std::atomic<bool> reachable = true;
  std::atomic<bool> refuses_credentials = false;
  std::atomic<std::int64_t> now_ns = 1'000'000'000;
  std::atomic<int> wakes = 0;
  std::mutex turns_mutex;
  std::condition_variable turns_changed;
  std::map<const void*, int> turns;  // of each node: how often it has waited

  void Join(const void* node) {
    const std::lock_guard lock(turns_mutex);
    const int slowest = turns.empty() ? 0 : Slowest();
    turns[node] = slowest;
  }
  void Leave(const void* node) {
    const std::lock_guard lock(turns_mutex);
    turns.erase(node);
    turns_changed.notify_all();
  }
  // Every node waits; together they let the time pass once.
  void Wait(const void* node, Time time) {
    std::unique_lock lock(turns_mutex);
    now_ns += time.count() / static_cast<std::int64_t>(turns.size());
    ++turns[node];
    turns_changed.notify_all();
    turns_changed.wait(lock, [&] { return turns[node] <= Slowest() + 1; });
  }
  [[nodiscard]] int Slowest() const {
    int slowest = std::numeric_limits<int>::max();
    for (const auto& [node, count] : turns) slowest = std::min(slowest, count);
    return slowest;
  }

  [[nodiscard]] Time Now() const { return Time(now_ns.load()); }
};

class FakeStore : public Store {
 public:
  explicit FakeStore(World* world) : world_(world) {}
  ~FakeStore() override { world_->Leave(this); }

  bool Open(std::string* /*why*/) override {
    world_->Join(this);
    return true;
  }
  bool connected() override { return world_->reachable; }
  bool refuses_credentials() const override { return world_->refuses_credentials; }
  void Put(const StorePut& put) override {
    if (!connected()) return;
    const std::lock_guard lock(world_->mutex);
    StoreRecord& record = world_->records[put.key];
    const bool done = record.revision == put.expected;
    if (done) record = {put.key, put.value, ++world_->revision};
    answers_.push_back({put.id, done ? WriteResult::kDone : WriteResult::kRefused,
                        done ? world_->revision : Revision{0}});
    if (record.revision == 0) world_->records.erase(put.key);
  }
  bool Poll(milliseconds wait, std::vector<StoreAnswer>* answers,
            std::vector<StoreRecord>* changes) override {
    world_->Wait(this, wait);
    *answers = std::exchange(answers_, {});
    const std::lock_guard lock(world_->mutex);
    if (world_->incarnation != incarnation_) return false;
    for (const auto& [key, record] : world_->records) {
      if (record.revision > heard_) changes->push_back(record);
    }
    heard_ = world_->revision;
    return true;
  }
  void Wake() override { ++world_->wakes; }
  bool List(std::uint64_t* incarnation, std::vector<StoreRecord>* records,
            std::string* /*why*/) override {
    if (!connected()) return false;
    const std::lock_guard lock(world_->mutex);
    for (const auto& [key, record] : world_->records) records->push_back(record);
    *incarnation = incarnation_ = world_->incarnation;
    heard_ = world_->revision;
    return true;
  }

 private:
  World* const world_;
  std::vector<StoreAnswer> answers_;
  std::uint64_t incarnation_ = 0;
  Revision heard_ = 0;
};

class StoreCoordinatorTest : public ::testing::Test {
 protected:
  StoreCoordinator& Add(const std::string& name, int capacity = 10) {
    auto node = std::make_unique<StoreCoordinator>(StoreCoordinator::Parts{
        .store = std::make_unique<FakeStore>(&world_),
        .node = name,
        .run = ++runs_,
        .capacity = capacity,
        .strict = false,
        .now = [this] { return world_.Now(); },
        .pause = [] { return Time{0}; },
        .unix_ms = [this] { return 1'700'000'000'000 + world_.Now() / milliseconds(1); }});
    EXPECT_TRUE(node->Start({name, "host-" + name, 7400, 7401, 7480}).ok());
    nodes_.push_back(std::move(node));
    return *nodes_.back();
  }
  // Waits until it is true; a test that fails waits for 20 s.
  static bool Becomes(const std::function<bool()>& condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (std::chrono::steady_clock::now() < end) {
      if (condition()) return true;
      std::this_thread::yield();
    }
    return false;
  }
  bool IsReady(const StoreCoordinator& node) {
    return Becomes([&] { return node.Fault(world_.Now()).empty(); });
  }
  // Offers the subject until the node serves it.
  bool Takes(StoreCoordinator& node, const std::string& subject) {
    return Becomes([&] { return node.Ask(subject, world_.Now()).kind == Place::Kind::kHere; });
  }
  // The node learns that another one serves the subject.
  bool Sees(StoreCoordinator& node, const std::string& subject, const std::string& holder) {
    return Becomes([&] {
      const Place place = node.Elsewhere(subject);
      return place.kind == Place::Kind::kElsewhere && place.node.name == holder;
    });
  }

  World world_;
  std::uint64_t runs_ = 0;
  std::vector<std::unique_ptr<StoreCoordinator>> nodes_;
};

TEST_F(StoreCoordinatorTest, OneNodeServesAndTheOthersKnowWhere) {
  StoreCoordinator& a = Add("a");
  StoreCoordinator& b = Add("b");
  ASSERT_TRUE(IsReady(a));
  ASSERT_TRUE(IsReady(b));
  ASSERT_TRUE(Takes(a, "ada"));
  ASSERT_TRUE(Sees(b, "ada", "a"));
  const Place place = b.Ask("ada", world_.Now());
  EXPECT_EQ(place.kind, Place::Kind::kElsewhere);
  EXPECT_EQ(place.node.host, "host-a");
  EXPECT_EQ(place.epoch, a.Find("ada", world_.Now()).epoch);
  // A new subject is proposed for the emptier node.
  EXPECT_TRUE(Becomes([&] { return a.Propose("bob", world_.Now()).node.name == "b"; }));
}

TEST_F(StoreCoordinatorTest, AReleasedSubjectMovesAtOnceAndUpwards) {
  StoreCoordinator& a = Add("a");
  StoreCoordinator& b = Add("b");
  ASSERT_TRUE(IsReady(a));
  ASSERT_TRUE(IsReady(b));
  ASSERT_TRUE(Takes(a, "ada"));
  const std::uint64_t epoch = a.Find("ada", world_.Now()).epoch;
  ASSERT_TRUE(Sees(b, "ada", "a"));
  a.Release("ada");
  ASSERT_TRUE(Takes(b, "ada"));
  EXPECT_GT(b.Find("ada", world_.Now()).epoch, epoch);
}

TEST_F(StoreCoordinatorTest, RefusedCredentialsAreNoUnreachableStore) {
  StoreCoordinator& a = Add("a");
  ASSERT_TRUE(IsReady(a));
  const auto says = [&](const char* what) {
    return Becomes([&] { return a.Fault(world_.Now()).find(what) != std::string::npos; });
  };
  world_.reachable = false;
  EXPECT_TRUE(says("cannot be reached"));
  world_.refuses_credentials = true;
  EXPECT_TRUE(says("refuses the credentials"));
  world_.refuses_credentials = false;
  world_.reachable = true;
  EXPECT_TRUE(IsReady(a));
}

// Viewers wait while a subject moves, so no part of it waits for the next look at the requests.
TEST_F(StoreCoordinatorTest, AMoveDoesNotWaitForTheStore) {
  StoreCoordinator& a = Add("a");
  StoreCoordinator& b = Add("b");
  ASSERT_TRUE(IsReady(a));
  ASSERT_TRUE(IsReady(b));
  ASSERT_TRUE(Takes(a, "ada"));
  EXPECT_EQ(world_.wakes, 0);
  a.SetDraining();
  EXPECT_EQ(world_.wakes, 1);
  ASSERT_EQ(b.Expect("ada", world_.Now()).kind, Place::Kind::kPending);
  EXPECT_EQ(world_.wakes, 2);
  a.HandOver("ada", {"b", "host-b", 7400, 7401, 7480});
  EXPECT_EQ(world_.wakes, 3);
}

TEST_F(StoreCoordinatorTest, ASubjectIsHandedOverAndNoThirdNodeGetsIt) {
  StoreCoordinator& a = Add("a");
  StoreCoordinator& b = Add("b");
  StoreCoordinator& c = Add("c");
  for (StoreCoordinator* node : {&a, &b, &c}) ASSERT_TRUE(IsReady(*node));
  ASSERT_TRUE(Takes(a, "ada"));
  ASSERT_TRUE(Sees(b, "ada", "a"));
  ASSERT_TRUE(Sees(c, "ada", "a"));
  const std::uint64_t epoch = a.Find("ada", world_.Now()).epoch;
  a.SetDraining();
  // The heir sends nobody back while it waits.
  EXPECT_EQ(b.Expect("ada", world_.Now()).kind, Place::Kind::kPending);
  EXPECT_EQ(b.Elsewhere("ada").kind, Place::Kind::kNowhere);
  EXPECT_EQ(b.Ask("ada", world_.Now()).kind, Place::Kind::kPending);
  // The node that hands it over goes on until then, and sends everybody away from then on.
  EXPECT_EQ(a.Ask("ada", world_.Now()).kind, Place::Kind::kHere);
  (void)c.Ask("ada", world_.Now());
  a.HandOver("ada", {"b", "host-b", 7400, 7401, 7480});
  for (const Place& place :
       {a.Ask("ada", world_.Now()), a.Find("ada", world_.Now()), a.Elsewhere("ada")}) {
    EXPECT_EQ(place.kind, Place::Kind::kElsewhere);
    EXPECT_EQ(place.node.name, "b");
  }
  ASSERT_TRUE(Takes(b, "ada"));
  EXPECT_GT(b.Find("ada", world_.Now()).epoch, epoch);
  EXPECT_TRUE(Sees(c, "ada", "b"));
  EXPECT_TRUE(Sees(a, "ada", "b"));
}

TEST_F(StoreCoordinatorTest, AnExpectedSubjectThatNeverComesIsForgotten) {
  StoreCoordinator& a = Add("a");
  StoreCoordinator& b = Add("b");
  ASSERT_TRUE(IsReady(a));
  ASSERT_TRUE(IsReady(b));
  ASSERT_TRUE(Takes(a, "ada"));
  ASSERT_TRUE(Sees(b, "ada", "a"));
  EXPECT_EQ(b.Expect("ada", world_.Now()).kind, Place::Kind::kPending);
  EXPECT_EQ(b.Elsewhere("ada").kind, Place::Kind::kNowhere);
  EXPECT_TRUE(Sees(b, "ada", "a")) << "after a while";
  b.SetDraining();
  EXPECT_EQ(b.Expect("ada", world_.Now()).why, "this node is draining");
}

TEST_F(StoreCoordinatorTest, SubjectsThatAreHandedOverAreSpread) {
  StoreCoordinator& a = Add("a");
  for (const char* name : {"b", "c"}) ASSERT_TRUE(IsReady(Add(name)));
  ASSERT_TRUE(IsReady(a));
  std::map<std::string, int> given;
  ASSERT_TRUE(Becomes([&] { return a.Others().size() == 2; }));
  for (const char* subject : {"s1", "s2", "s3", "s4"}) {
    ASSERT_TRUE(Takes(a, subject));
    ASSERT_TRUE(Becomes([&] { return a.Successor(subject, {}).kind == Place::Kind::kElsewhere; }));
    const NodeAddress heir = a.Successor(subject, {}).node;
    a.HandOver(subject, heir);
    ++given[heir.name];
  }
  EXPECT_EQ(given, (std::map<std::string, int>{{"b", 2}, {"c", 2}}));
  ASSERT_TRUE(Takes(a, "s5"));
  EXPECT_EQ(a.Successor("s5", {"b"}).node.name, "c");
  EXPECT_EQ(a.Successor("s5", {"b", "c"}).why, "no other node has room");
}

TEST_F(StoreCoordinatorTest, ANodeExpectsNoMoreSubjectsThanItHasRoomFor) {
  StoreCoordinator& a = Add("a", 2);
  ASSERT_TRUE(IsReady(a));
  // The clock stands, so the leases are not there yet.
  const std::lock_guard standing(world_.turns_mutex);
  EXPECT_EQ(a.Expect("s1", world_.Now()).kind, Place::Kind::kPending);
  EXPECT_EQ(a.Expect("s2", world_.Now()).kind, Place::Kind::kPending);
  EXPECT_EQ(a.Expect("s2", world_.Now()).kind, Place::Kind::kPending) << "again";
  EXPECT_EQ(a.Expect("s3", world_.Now()).why, "this node is full");
}

TEST_F(StoreCoordinatorTest, ANodeThatEndsGivesItsLeasesBack) {
  Add("a");
  StoreCoordinator& b = Add("b");
  ASSERT_TRUE(IsReady(*nodes_[0]));
  ASSERT_TRUE(IsReady(b));
  ASSERT_TRUE(Takes(*nodes_[0], "ada"));
  nodes_[0].reset();
  {
    const std::lock_guard lock(world_.mutex);
    const auto lease = ParseLease(world_.records.at(LeaseKey("ada")).value);
    ASSERT_TRUE(lease);
    EXPECT_EQ(lease->node, "");
  }
  EXPECT_TRUE(Takes(b, "ada"));
}

TEST_F(StoreCoordinatorTest, AFullOrDrainingNodeNamesAnotherOne) {
  StoreCoordinator& a = Add("a", 1);
  StoreCoordinator& b = Add("b");
  ASSERT_TRUE(IsReady(a));
  ASSERT_TRUE(IsReady(b));
  ASSERT_TRUE(Takes(a, "ada"));
  EXPECT_TRUE(Becomes([&] {
    const Place place = a.Ask("bob", world_.Now());
    return place.kind == Place::Kind::kElsewhere && place.node.name == "b";
  }));
  b.SetDraining();
  EXPECT_TRUE(Becomes([&] {
    const Place place = a.Ask("bob", world_.Now());
    return place.kind == Place::Kind::kNowhere &&
           place.why == "this node is full, and no other node has room";
  }));
  const Place place = b.Ask("eve", world_.Now());
  EXPECT_TRUE(place.kind == Place::Kind::kNowhere || place.kind == Place::Kind::kElsewhere);
}

TEST_F(StoreCoordinatorTest, ASubjectThatIsServedHereHasASuccessorElsewhere) {
  StoreCoordinator& a = Add("a");
  StoreCoordinator& b = Add("b");
  ASSERT_TRUE(IsReady(a));
  ASSERT_TRUE(IsReady(b));
  ASSERT_TRUE(Takes(a, "ada"));
  a.SetDraining();
  EXPECT_TRUE(Becomes([&] {
    const Place place = a.Successor("ada", {});
    return place.kind == Place::Kind::kElsewhere && place.node.name == "b";
  }));
  b.SetDraining();
  EXPECT_TRUE(Becomes([&] { return a.Successor("ada", {}).kind == Place::Kind::kNowhere; }));
}

TEST_F(StoreCoordinatorTest, WithoutTheStoreSubjectsStayAndNothingIsTaken) {
  StoreCoordinator& a = Add("a");
  ASSERT_TRUE(IsReady(a));
  ASSERT_TRUE(Takes(a, "ada"));
  const std::uint64_t epoch = a.Find("ada", world_.Now()).epoch;
  world_.reachable = false;
  ASSERT_TRUE(Becomes(
      [&] { return a.Fault(world_.Now()) == "the store of the cluster cannot be reached"; }));
  const Time until = world_.Now() + std::chrono::seconds(30);
  ASSERT_TRUE(Becomes([&] { return world_.Now() >= until; }));
  EXPECT_TRUE(Becomes([&] { return a.Find("ada", world_.Now()).epoch == epoch; }));
  EXPECT_EQ(a.Ask("bob", world_.Now()).kind, Place::Kind::kNowhere);
  // It comes back without its data.
  {
    const std::lock_guard lock(world_.mutex);
    world_.records.clear();
    world_.revision = 0;
    ++world_.incarnation;
  }
  world_.reachable = true;
  ASSERT_TRUE(IsReady(a));
  EXPECT_TRUE(Takes(a, "ada"));
  EXPECT_GE(a.Find("ada", world_.Now()).epoch, epoch);
  EXPECT_TRUE(Takes(a, "bob"));
}

TEST_F(StoreCoordinatorTest, TwoNodesOfOneNameAreAFault) {
  StoreCoordinator& a = Add("a");
  ASSERT_TRUE(IsReady(a));
  StoreCoordinator& rival = Add("a");
  EXPECT_TRUE(Becomes([&] {
    return rival.Fault(world_.Now()) ==
           "another daemon of the cluster has the name 'a'; give each its own --name";
  }));
  const Place place = rival.Ask("ada", world_.Now());
  EXPECT_EQ(place.kind, Place::Kind::kNowhere);
  EXPECT_EQ(place.why, rival.Fault(world_.Now()));
}

TEST_F(StoreCoordinatorTest, RecordsThatCannotBeReadAreFree) {
  {
    const std::lock_guard lock(world_.mutex);
    world_.records = {{LeaseKey("ada"), {LeaseKey("ada"), "not a lease", 3}},
                      {"lease.zz", {"lease.zz", "1 b 1 1 1", 4}},
                      {"node.b", {"node.b", "1 2 3", 5}}};
    world_.revision = 5;
  }
  StoreCoordinator& a = Add("a");
  ASSERT_TRUE(IsReady(a));
  EXPECT_TRUE(Takes(a, "ada"));
  EXPECT_EQ(a.State(world_.Now()).nodes.size(), 1u);
}

}  // namespace
}  // namespace furrow::server
