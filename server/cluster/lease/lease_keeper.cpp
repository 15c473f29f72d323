// SPDX-License-Identifier: Apache-2.0
#include "server/cluster/lease/lease_keeper.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

namespace furrow::server {
namespace {

// The pause after an attempt to take a lease.
constexpr Time kNextAttempt = std::chrono::milliseconds(200);

constexpr std::int64_t kTtlMs =
    std::chrono::duration_cast<std::chrono::milliseconds>(kLeaseTtl).count();

}  // namespace

void LeaseKeeper::Want(std::string_view subject) {
  Own& own = own_.try_emplace(std::string(subject)).first->second;
  own.wanted = true;
  own.heir.reset();
}

void LeaseKeeper::Release(std::string_view subject) {
  const auto found = own_.find(subject);
  if (found == own_.end()) return;
  GiveUp(found->second);
}

void LeaseKeeper::HandOver(std::string_view subject, std::string_view node, std::uint64_t run) {
  const auto found = own_.find(subject);
  if (found == own_.end()) return;
  GiveUp(found->second);
  found->second.heir = Heir{std::string(node), run};
}

void LeaseKeeper::ReleaseAll() {
  for (auto& [subject, own] : own_) GiveUp(own);
}

void LeaseKeeper::GiveUp(Own& own) {
  own.wanted = own.held = own.isolated = false;
  own.candidate.reset();
  own.next_write = Time{0};
}

const LeaseKeeper::Record* LeaseKeeper::Find(std::string_view subject) const {
  const auto found = records_.find(subject);
  return found == records_.end() ? nullptr : &found->second;
}

bool LeaseKeeper::MayTake(Time now) const {
  return reachable_ && listed_ && now >= known_since_ + kLeaseTtl;
}

void LeaseKeeper::OnReachable(bool reachable, Time now) {
  if (reachable == reachable_) return;
  reachable_ = reachable;
  listed_ = false;
  needs_listing_ = true;
  if (reachable) {
    reachable_since_ = heard_ = now;
    return;
  }
  for (auto& [subject, own] : own_) {
    own.pending.clear();
    own.candidate.reset();
    // Noticing that the store is gone takes time, in which a lease may end.
    own.isolated = !strict_ && (own.isolated || IsGood(own, heard_));
  }
}

void LeaseKeeper::OnListing(const LeaseListing& listing, Time now) {
  if (!reachable_) return;
  heard_ = now;
  std::map<std::string, Record, std::less<>> former;
  if (listing.incarnation == incarnation_) {
    former.swap(records_);
  } else {
    records_.clear();
    incarnation_ = listing.incarnation;
    known_since_ = now;
  }
  for (const LeaseEntry& entry : listing.entries) {
    const auto known = former.find(entry.subject);
    // The listing may be older than a write of this node, or than a hint.
    if (known != former.end() && known->second.revision > entry.revision) {
      records_.insert(former.extract(known));
      continue;
    }
    // A holder that could not reach the store either has not been late.
    const bool same = listed_ && known != former.end() && known->second.revision == entry.revision;
    const Time seen = same ? known->second.seen : now;
    Learn(entry, seen);
  }
  listed_ = true;
  needs_listing_ = frozen_ = false;
  for (auto& [subject, own] : own_) {
    own.stale = false;
    Settle(subject, own);
  }
}

void LeaseKeeper::OnEntry(const LeaseEntry& entry, Time now) {
  if (!reachable_ || !listed_) return;
  const Record* const known = Find(entry.subject);
  if (known != nullptr && known->revision >= entry.revision) return;
  Learn(entry, now);
  if (const auto own = own_.find(entry.subject); own != own_.end()) {
    Settle(entry.subject, own->second);
  }
}

void LeaseKeeper::NoteEpoch(std::uint64_t epoch) {
  if (epoch <= std::max(wall_, kLeastClock) + kMaxEpochAhead) highest_ = std::max(highest_, epoch);
}

void LeaseKeeper::Learn(const LeaseEntry& entry, Time now) {
  NoteEpoch(entry.lease.epoch);
  records_.insert_or_assign(entry.subject, Record{entry.lease, entry.revision, now});
}

// Compares what this node believes with what the store says.
void LeaseKeeper::Settle(const std::string& subject, Own& own) const {
  const Record* const record = Find(subject);
  if (record != nullptr && !IsOwn(record->lease)) {
    own.held = own.isolated = false;
    own.candidate.reset();
    return;
  }
  if (!own.candidate) return;
  if (own.candidate->incarnation != incarnation_) {
    own.candidate.reset();
  } else if (record != nullptr && record->lease.epoch == own.candidate->epoch) {
    own.epoch = own.candidate->epoch;
    own.good = own.candidate->good;
    own.held = true;
    own.isolated = false;
    own.candidate.reset();
  }
}

void LeaseKeeper::OnWritten(std::string_view subject, std::uint64_t write, WriteResult result,
                            Revision revision, Time now) {
  if (result != WriteResult::kUnknown) heard_ = std::max(heard_, now);
  const auto known = own_.find(subject);
  if (known == own_.end()) return;
  Own& own = known->second;
  const auto found = own.pending.find(write);
  if (found == own.pending.end()) return;
  const Pending done = std::move(found->second);
  own.pending.erase(found);
  if (result == WriteResult::kDone) {
    OnDone(known->first, own, done, revision, now);
    if (!IsOwn(done.lease) && !own.wanted) own_.erase(known);
  } else {
    own.next_write = now;
    own.stale = needs_listing_ = true;
  }
}

void LeaseKeeper::OnDone(const std::string& subject, Own& own, const Pending& done,
                         Revision revision, Time now) {
  // Its revision means nothing in a store that was emptied since. It would hide the records of
  // other nodes until their revisions have grown beyond it.
  if (done.incarnation != incarnation_) {
    needs_listing_ = true;
    return;
  }
  const Record* const known = Find(subject);
  if (known == nullptr || known->revision < revision) {
    Learn({subject, done.lease, revision}, now);
  }
  if (!own.wanted || !IsOwn(done.lease)) return;
  if (done.inherits && done.lease.epoch > own.epoch) {
    // It replaced a record of a certain revision, which an emptied store does not have. So the
    // write reached the store in which the holder gave the lease away.
    own.epoch = done.lease.epoch;
    own.good = done.sent;
    own.held = true;
    own.isolated = false;
    own.candidate.reset();
  } else if (own.held && own.epoch == done.lease.epoch) {
    own.good = std::max(own.good, done.sent);
    own.isolated = false;
  } else if (own.candidate && own.candidate->epoch == done.lease.epoch) {
    own.candidate->good = std::max(own.candidate->good, done.sent);
  } else if (done.lease.epoch > own.epoch) {
    // A write that was under way while the store was emptied would count in the new store. Only a
    // listing shows which one it is.
    own.candidate = Candidate{done.lease.epoch, done.sent, done.incarnation};
    needs_listing_ = true;
  }
}

// What this node writes instead of a lease that it no longer wants. The epoch is remembered.
Lease LeaseKeeper::Farewell(const Own& own, const Record& record, std::int64_t unix_ms) {
  Lease lease{.node = {}, .run = 0, .epoch = record.lease.epoch, .deadline_ms = 0};
  if (!own.heir || lease.epoch >= kMaxEpoch) return lease;
  return {.node = own.heir->node,
          .run = own.heir->run,
          .epoch = lease.epoch + 1,
          .deadline_ms = unix_ms + kTtlMs};
}

// True if the record continues the lease that this node holds or has just taken.
bool LeaseKeeper::Keeps(const Own& own, const Lease& lease) const {
  if (!IsOwn(lease)) return false;
  return (own.held && own.epoch == lease.epoch) ||
         (own.candidate && own.candidate->epoch == lease.epoch);
}

std::optional<Lease> LeaseKeeper::NextLease(const Own& own, const Record* record, Time now,
                                            std::int64_t unix_ms) const {
  Lease lease{.node = node_, .run = run_, .epoch = own.epoch, .deadline_ms = unix_ms + kTtlMs};
  const bool keeps = record == nullptr ? IsGood(own, now) : Keeps(own, record->lease);
  if (keeps) {
    if (record != nullptr) lease.epoch = record->lease.epoch;
    return lease;
  }
  const bool is_foreign = record != nullptr && !record->lease.node.empty() && !IsOwn(record->lease);
  if (!MayTake(now) || (is_foreign && now < record->seen + kLeaseTtl)) return std::nullopt;
  const auto wall = static_cast<std::uint64_t>(std::max<std::int64_t>(unix_ms, 1));
  lease.epoch = std::max(wall, highest_ + 1);
  if (lease.epoch > kMaxEpoch) return std::nullopt;
  return lease;
}

std::optional<LeaseWrite> LeaseKeeper::NextWrite(const std::string& subject, Own& own, Time now,
                                                 std::int64_t unix_ms) {
  const bool waits = std::ranges::any_of(own.pending, [now](const auto& pending) {
    return now < pending.second.sent + kLeaseWriteTime;
  });
  if (waits || MustList(own) || now < own.next_write) return std::nullopt;
  const Record* const record = Find(subject);
  std::optional<Lease> lease;
  if (own.wanted) {
    lease = NextLease(own, record, now, unix_ms);
  } else if (record != nullptr && IsOwn(record->lease)) {
    lease = Farewell(own, *record, unix_ms);
  }
  if (!lease) return std::nullopt;
  own.next_write = now + (own.held && !own.isolated ? kLeaseRenewal : kNextAttempt);
  if (own.pending.size() >= kMaxPending) own.pending.erase(own.pending.begin());
  const std::uint64_t id = next_write_++;
  const bool inherits = record != nullptr && IsOwn(record->lease) && !Keeps(own, record->lease);
  own.pending.emplace(id, Pending{*lease, now, incarnation_, inherits});
  return LeaseWrite{id, subject, *std::move(lease), record == nullptr ? 0 : record->revision};
}

std::vector<LeaseWrite> LeaseKeeper::Tick(Time now, std::int64_t unix_ms) {
  last_tick_ = now;
  const auto wall = static_cast<std::uint64_t>(std::max<std::int64_t>(unix_ms, 1));
  // Records that came before the time was known.
  if (std::exchange(wall_, wall) == 0) {
    for (const auto& [subject, record] : records_) NoteEpoch(record.lease.epoch);
  }
  std::vector<LeaseWrite> writes;
  if (!reachable_ || !listed_) return writes;
  if (now > reachable_since_ + kLeaseTtl + kLeaseStop) EndIsolation();
  for (auto it = own_.begin(); it != own_.end();) {
    const auto current = it++;
    Own& own = current->second;
    if (auto write = NextWrite(current->first, own, now, unix_ms)) {
      writes.push_back(*std::move(write));
    } else if (!own.wanted && !MustList(own) && own.pending.empty() && now >= own.next_write) {
      own_.erase(current);  // there is nothing to release
    }
  }
  return writes;
}

// What the store said before a freeze proves nothing any more. If it was emptied meanwhile, a
// record of another node may have the revision that this node would replace.
void LeaseKeeper::OnPause(Time pause, Time now) {
  if (pause <= kLeaseFreeze) return;
  heard_ = now;
  needs_listing_ = frozen_ = true;
}

void LeaseKeeper::EndIsolation() {
  for (auto& [subject, own] : own_) own.isolated = false;
}

std::optional<LeaseKeeper::Serving> LeaseKeeper::ServingOf(std::string_view subject,
                                                           Time now) const {
  const auto found = own_.find(subject);
  return found == own_.end() ? std::nullopt : ServingOf(found->second, now);
}

std::optional<LeaseKeeper::Serving> LeaseKeeper::ServingOf(const Own& own, Time now) const {
  if (!own.held) return std::nullopt;
  Time until = own.good + kLeaseStop;
  if (own.isolated && last_tick_) until = std::max(until, *last_tick_ + kLeaseFreeze);
  return now < until ? std::optional(Serving{own.epoch, until}) : std::nullopt;
}

std::map<std::string, LeaseKeeper::Serving, std::less<>> LeaseKeeper::AllServing(Time now) const {
  std::map<std::string, Serving, std::less<>> all;
  for (const auto& [subject, own] : own_) {
    if (const auto serving = ServingOf(own, now)) all.emplace(subject, *serving);
  }
  return all;
}

std::string_view LeaseKeeper::HolderOf(std::string_view subject, Time now) const {
  const Record* const record = Find(subject);
  if (record == nullptr || IsOwn(record->lease)) return {};
  // Without the store, nobody knows better.
  if (reachable_ && listed_ && now >= record->seen + kLeaseTtl) return {};
  return record->lease.node;
}

void LeaseKeeper::ForEachForeign(
    Time now,
    const std::function<void(const std::string& subject, const Lease& lease)>& visit) const {
  for (const auto& [subject, record] : records_) {
    if (!HolderOf(subject, now).empty()) visit(subject, record.lease);
  }
}

}  // namespace furrow::server
