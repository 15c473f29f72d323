// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/cluster/lease/lease.h"

namespace furrow::server {

// Takes, renews and gives up the leases of one node. A state machine without I/O and clocks: the
// caller passes in what the store says and sends the writes that Tick() returns.
//
// - A lease counts from the moment at which its last confirmed write was sent, so a late answer
//   prolongs nothing. It is served until kLeaseStop after that.
// - A foreign lease is taken over once its record did not change for kLeaseTtl since this node saw
//   it. No clocks of different nodes are compared.
// - A node that meets a store, or an emptied one, for the first time takes no lease for kLeaseTtl:
//   by then every holder has written its lease again, or has stopped.
// - A new epoch is max(Unix time in ms, highest one seen + 1).
// - While the store cannot be reached, nothing new is taken. Leases that were good then are served
//   on, unless `strict`: nobody can take them over in a store that is gone. If only this node has
//   lost it, another one may serve the subject too, in a higher epoch, which receivers prefer.
//
// Not thread-safe.
class LeaseKeeper {
 public:
  // `run`: random, of this process. `strict`: without the store, stop after kLeaseStop.
  LeaseKeeper(std::string node, std::uint64_t run, bool strict = false)
      : node_(std::move(node)), run_(run), strict_(strict) {}

  // This node wants to serve the subject, until Release().
  void Want(std::string_view subject);
  // Gives the lease back, so that another node need not wait.
  void Release(std::string_view subject);
  // Gives the lease to another node, in the next epoch: no third one can take it in between. The
  // heir must want it, and serves it once it has written it again. `run`: of the heir's process.
  void HandOver(std::string_view subject, std::string_view node, std::uint64_t run);
  // The same as Release() for all, also for those that are wanted and not held yet. Those that are
  // on their way to another node go on.
  void ReleaseAll();

  // The longest time for which the process has not run since the last call, see Pulse. Call it
  // before the others. A pause above kLeaseFreeze is a freeze: whatever was known may be wrong.
  void OnPause(Time pause, Time now);
  // The store answers or does not. A listing must follow after it answers again.
  void OnReachable(bool reachable, Time now);
  // `listing`: requested after the last freeze.
  void OnListing(const LeaseListing& listing, Time now);
  // One record has changed. Only a hint: the next listing counts.
  void OnEntry(const LeaseEntry& entry, Time now);
  // `subject`, `write`: of the LeaseWrite. `revision`: of the record that was written; only with
  // kDone.
  void OnWritten(std::string_view subject, std::uint64_t write, WriteResult result,
                 Revision revision, Time now);

  // The writes that must be sent now. Call it every 100 ms or more often. `unix_ms`: the time of
  // the system's clock.
  [[nodiscard]] std::vector<LeaseWrite> Tick(Time now, std::int64_t unix_ms);
  // True if the store must be listed, because what is known may be wrong.
  [[nodiscard]] bool needs_listing() const { return needs_listing_; }

  // Until when this node may serve the subject, and in which epoch. Nothing: not now.
  struct Serving {
    std::uint64_t epoch = 0;
    Time until{0};
  };
  [[nodiscard]] std::optional<Serving> ServingOf(std::string_view subject, Time now) const;
  [[nodiscard]] std::map<std::string, Serving, std::less<>> AllServing(Time now) const;
  // True until everything that was held has been released.
  [[nodiscard]] bool holds_any() const { return !own_.empty(); }
  // The other node that holds the subject; empty if none does.
  [[nodiscard]] std::string_view HolderOf(std::string_view subject, Time now) const;
  // Every foreign lease that is in force.
  void ForEachForeign(
      Time now,
      const std::function<void(const std::string& subject, const Lease& lease)>& visit) const;
  [[nodiscard]] bool reachable() const { return reachable_; }
  // Leases may be taken: the store is reachable and has been known for long enough.
  [[nodiscard]] bool MayTake(Time now) const;

 private:
  // A record in the store, as this node knows it.
  struct Record {
    Lease lease;
    Revision revision = 0;
    Time seen{0};  // when this revision was first seen
  };
  // A write without an answer yet.
  struct Pending {
    Lease lease;
    Time sent{0};
    std::uint64_t incarnation = 0;
    bool inherits = false;  // it replaces a record in which another node names this one
  };
  // The node that gets the lease instead of nobody.
  struct Heir {
    std::string node;
    std::uint64_t run = 0;
  };
  // A lease that was written, but not seen in a listing yet.
  struct Candidate {
    std::uint64_t epoch = 0;
    Time good{0};
    std::uint64_t incarnation = 0;
  };
  // A subject that this node wants or holds.
  struct Own {
    std::uint64_t epoch = 0;
    Time good{0};  // when the last confirmed write was sent
    bool held = false;
    bool isolated = false;  // served on while the store cannot be reached
    bool wanted = true;     // false: to be released
    bool stale = false;     // see MustList()
    Time next_write{0};
    std::optional<Heir> heir;  // only if not wanted
    std::optional<Candidate> candidate;
    std::map<std::uint64_t, Pending> pending;  // by the number of the write; at most kMaxPending
  };
  static constexpr std::size_t kMaxPending = 4;

  [[nodiscard]] bool IsOwn(const Lease& lease) const {
    return lease.run == run_ && lease.node == node_;
  }
  [[nodiscard]] bool IsGood(const Own& own, Time now) const {
    return own.held && now < own.good + kLeaseStop;
  }
  // A listing must come before the next write.
  [[nodiscard]] bool MustList(const Own& own) const { return own.stale || frozen_; }
  [[nodiscard]] const Record* Find(std::string_view subject) const;
  [[nodiscard]] std::optional<Serving> ServingOf(const Own& own, Time now) const;
  [[nodiscard]] bool Keeps(const Own& own, const Lease& lease) const;
  [[nodiscard]] static Lease Farewell(const Own& own, const Record& record, std::int64_t unix_ms);
  [[nodiscard]] std::optional<Lease> NextLease(const Own& own, const Record* record, Time now,
                                               std::int64_t unix_ms) const;
  [[nodiscard]] std::optional<LeaseWrite> NextWrite(const std::string& subject, Own& own, Time now,
                                                    std::int64_t unix_ms);
  static void GiveUp(Own& own);
  void NoteEpoch(std::uint64_t epoch);
  void Learn(const LeaseEntry& entry, Time now);
  void EndIsolation();
  void Settle(const std::string& subject, Own& own) const;
  void OnDone(const std::string& subject, Own& own, const Pending& done, Revision revision,
              Time now);

  const std::string node_;
  const std::uint64_t run_;
  const bool strict_;
  std::map<std::string, Record, std::less<>> records_;
  std::map<std::string, Own, std::less<>> own_;
  std::uint64_t next_write_ = 1;
  std::uint64_t wall_ = 0;     // of the last Tick(): the system's clock in ms; 0: none yet
  std::uint64_t highest_ = 0;  // of all epochs that were seen, except absurd ones
  bool reachable_ = false;
  bool listed_ = false;  // since the store is reachable
  bool needs_listing_ = true;
  bool frozen_ = false;  // not listed since a freeze
  std::uint64_t incarnation_ = 0;
  Time known_since_{0};  // of the incarnation
  Time reachable_since_{0};
  Time heard_{0};  // the last answer of the store; after a freeze, its end
  std::optional<Time> last_tick_;
};

}  // namespace furrow::server
