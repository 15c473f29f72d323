// SPDX-License-Identifier: Apache-2.0
#include "server/cluster/store/store_coordinator.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <new>
#include <thread>
#include <utility>

#include <spdlog/spdlog.h>

namespace furrow::server {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kStep(50);
// While subjects move.
constexpr milliseconds kHurriedStep(5);
constexpr Time kHurry = std::chrono::seconds(1);
// The pause between two attempts to list the store.
constexpr Time kListPause = milliseconds(100);
// More cannot be wanted: one daemon has at most a million subjects.
constexpr std::size_t kMaxForeign = 1'000'000;

// The part of its places that a node has given away.
double LoadOf(int subjects, int capacity) {
  return static_cast<double>(subjects) / std::max(1, capacity);
}

}  // namespace

StoreCoordinator::StoreCoordinator(Parts parts)
    : run_(parts.run),
      capacity_(parts.capacity),
      now_(std::move(parts.now)),
      pause_(std::move(parts.pause)),
      unix_ms_(std::move(parts.unix_ms)),
      store_(std::move(parts.store)),
      leases_(parts.node, parts.run, parts.strict) {
  View first;
  first.fault = "the store of the cluster cannot be reached";
  view_ = std::make_shared<const View>(std::move(first));
}

Status StoreCoordinator::Start(const NodeAddress& self) {
  self_ = self;
  nodes_ = NodeTable({.address = self,
                      .run = run_,
                      .capacity = capacity_,
                      .subjects = 0,
                      .draining = false,
                      .ready = false});
  std::string why;
  if (!store_->Open(&why)) {
    return {StatusCode::kInvalidArgument, "cannot connect to the store: " + why, "--cluster"};
  }
  thread_ = std::jthread([this](const std::stop_token& stop) { Run(stop); });
  return {};
}

StoreCoordinator::~StoreCoordinator() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  thread_.join();
}

void StoreCoordinator::Run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    StepWithinMemory(draining_ || now_() < hurries_until_ ? kHurriedStep : kStep);
  }
  // So that other nodes need not wait for the end of the leases.
  {
    const std::lock_guard lock(mutex_);
    requests_.wanted.clear();
    requests_.draining = true;
  }
  leases_.ReleaseAll();
  const Time end = now_() + kFarewell;
  while (leases_.holds_any() && leases_.reachable() && now_() < end) {
    StepWithinMemory(milliseconds(10));
  }
}

// A step that lacks memory is as one whose messages were lost: leases are written again.
void StoreCoordinator::StepWithinMemory(milliseconds wait) {
  try {
    Step(wait);
  } catch (const std::bad_alloc&) {
    missed_ = true;
    spdlog::error("cluster: out of memory in a step; the next one repeats it");
    std::this_thread::sleep_for(wait);
  }
}

void StoreCoordinator::Step(milliseconds wait) {
  std::vector<StoreAnswer> answers;
  std::vector<StoreRecord> changes;
  LookAround();
  if (!store_->Poll(wait, &answers, &changes)) missed_ = true;
  LookAround();
  const Time now = now_();
  for (const StoreRecord& change : changes) OnRecord(change, nullptr, now);
  for (const StoreAnswer& answer : answers) {
    const auto write = writes_.find(answer.id);
    if (write == writes_.end()) {  // of an announcement
      missed_ |= answer.result == WriteResult::kRefused;
      continue;
    }
    leases_.OnWritten(write->second.subject, write->second.id, answer.result, answer.revision, now);
    writes_.erase(write);
  }
  if (!leases_.reachable()) writes_.clear();
  TakeRequests();
  if (leases_.reachable() && (missed_ || leases_.needs_listing()) && now - listed_ >= kListPause) {
    List();
  }
  LookAround();  // nothing is written on what was known before a freeze
  for (LeaseWrite& write : leases_.Tick(now_(), unix_ms_())) {
    const std::uint64_t id = next_id_++;
    store_->Put({id, LeaseKey(write.subject), ToText(write.lease), write.expected});
    writes_[id] = {std::move(write.subject), write.id};
  }
  // Answers that never came.
  constexpr std::size_t kMaxWrites = 100'000;
  while (writes_.size() > kMaxWrites) writes_.erase(writes_.begin());
  if (leases_.reachable() && !missed_) {
    if (auto put = nodes_.Tick(next_id_, now_())) {
      ++next_id_;
      store_->Put(*put);
    }
  }
  Publish(now_());
}

void StoreCoordinator::LookAround() {
  leases_.OnPause(pause_(), now_());
  leases_.OnReachable(store_->connected(), now_());
}

void StoreCoordinator::TakeRequests() {
  std::map<std::string, bool, std::less<>> wanted;
  std::map<std::string, std::string> heirs;
  {
    const std::lock_guard lock(mutex_);
    wanted.swap(requests_.wanted);
    heirs.swap(requests_.heirs);
    draining_ = requests_.draining;
  }
  const Time now = now_();
  if (transits_.ExpectsAny(now)) hurries_until_ = now + kHurry;
  const bool has_rival = nodes_.HasRival(now);
  for (const auto& [subject, is_wanted] : wanted) {
    if (!is_wanted) {
      leases_.Release(subject);
    } else if (!has_rival) {  // senders repeat their offers, and ask again
      leases_.Want(subject);
    }
  }
  const auto others = nodes_.Others(now, leases_.reachable());
  for (const auto& [subject, node] : heirs) {
    const auto heir = others.find(node);
    if (heir == others.end()) {
      leases_.Release(subject);
    } else {
      leases_.HandOver(subject, node, heir->second.run);
    }
  }
}

void StoreCoordinator::List() {
  LeaseListing listing;
  std::vector<StoreRecord> records;
  const bool listed = store_->List(&listing.incarnation, &records, &why_);
  const Time now = now_();
  listed_ = now;
  if (!listed) return;
  why_.clear();
  missed_ = false;
  nodes_.BeginListing();
  for (const StoreRecord& record : records) OnRecord(record, &listing.entries, now);
  nodes_.EndListing();
  leases_.OnListing(listing, now);
}

// Without `entries`: one change. Records that cannot be read are left out: whoever may write to the
// store cannot do more than that.
void StoreCoordinator::OnRecord(const StoreRecord& record, std::vector<LeaseEntry>* entries,
                                Time now) {
  if (const auto node = NodeOfKey(record.key)) {
    nodes_.OnRecord(*node, record.value, record.revision, now);
    return;
  }
  const auto subject = SubjectOfKey(record.key);
  if (!subject || (entries != nullptr && entries->size() >= kMaxForeign)) return;
  // Deleted and invalid records are free for the next lease. A record keeps its
  // revision, which the next write must name.
  LeaseEntry entry{*subject, ParseLease(record.value).value_or(Lease()), record.revision};
  if (entries != nullptr) {
    entries->push_back(std::move(entry));
  } else {
    leases_.OnEntry(entry, now);
  }
}

void StoreCoordinator::Publish(Time now) {
  auto next = std::make_shared<View>();
  next->own = leases_.AllServing(now);
  leases_.ForEachForeign(now, [&next](const std::string& subject, const Lease& lease) {
    next->foreign.emplace(subject, lease);
  });
  next->others = nodes_.Others(now, leases_.reachable());
  next->reachable = leases_.reachable();
  next->has_rival = nodes_.HasRival(now);
  next->may_take = leases_.MayTake(now) && !next->has_rival;
  if (next->has_rival) {
    next->fault =
        "another daemon of the cluster has the name '" + self_.name + "'; give each its own --name";
  } else if (!leases_.reachable()) {
    next->fault =
        store_->refuses_credentials()
            ? "the store of the cluster refuses the credentials; see --cluster-credentials"
            : "the store of the cluster cannot be reached";
  } else if (!why_.empty()) {
    next->fault = "the store of the cluster cannot be read: " + why_;
  } else if (!next->may_take) {
    next->fault = "the store of the cluster has been reached a moment ago";
  }
  nodes_.Update(static_cast<int>(next->own.size()), draining_, next->may_take);
  LogChanges(*next);
  const std::lock_guard lock(mutex_);
  view_ = std::move(next);
}

void StoreCoordinator::LogChanges(const View& view) {
  if (view.fault == logged_) return;
  logged_ = view.fault;
  if (view.fault.empty()) {
    spdlog::info("the cluster has {} more nodes; this one takes subjects", view.others.size());
  } else {
    spdlog::warn("nothing new is placed: {}", view.fault);
  }
}

bool StoreCoordinator::is_draining() const {
  const std::lock_guard lock(mutex_);
  return requests_.draining;
}

std::shared_ptr<const StoreCoordinator::View> StoreCoordinator::view() const {
  const std::lock_guard lock(mutex_);
  return view_;
}

void StoreCoordinator::Request(std::string_view subject, bool wanted) {
  const std::lock_guard lock(mutex_);
  requests_.wanted.insert_or_assign(std::string(subject), wanted);
}

void StoreCoordinator::Release(std::string_view subject) {
  Request(subject, false);
  transits_.ForgetExpected(subject);
}

// Subjects that are on their way here have a place, although the view does not show them yet.
bool StoreCoordinator::HasRoomFor(const View& view, std::string_view subject) const {
  const auto most = static_cast<std::size_t>(std::max(0, capacity_));
  const auto is_here = [&view](const std::string& name) { return view.own.contains(name); };
  return view.own.size() + transits_.CountExpected(subject, is_here, now_()) < most;
}

Place StoreCoordinator::Expect(std::string_view subject, Time now) {
  const auto seen = view();
  Place place;
  if (is_draining()) {
    place.why = "this node is draining";
  } else if (!HasRoomFor(*seen, subject)) {
    place.why = "this node is full";
  } else if (!seen->may_take) {
    place.why = seen->fault;
  } else {
    place.kind = Place::Kind::kPending;
    Request(subject, true);
    transits_.Expect(subject, now);
    store_->Wake();
  }
  return place;
}

void StoreCoordinator::HandOver(std::string_view subject, const NodeAddress& heir) {
  transits_.Give(subject, heir, now_());
  {
    const std::lock_guard lock(mutex_);
    requests_.heirs.insert_or_assign(std::string(subject), heir.name);
  }
  store_->Wake();
}

void StoreCoordinator::SetDraining() {
  {
    const std::lock_guard lock(mutex_);
    requests_.draining = true;
  }
  store_->Wake();
}

// The node with the largest part of its places free. Nodes announce themselves once per second, so
// what this one has given to them counts, too.
const Announcement* StoreCoordinator::RoomElsewhere(const View& view,
                                                    const std::set<std::string>& without) const {
  const Announcement* best = nullptr;
  double least = 0.0;
  if (!view.reachable) return best;  // no node takes anything
  for (const auto& [name, node] : view.others) {
    if (node.draining || !node.ready || node.subjects >= node.capacity) continue;
    if (without.contains(name)) continue;
    const double load = LoadOf(node.subjects + transits_.NumGivenTo(name), node.capacity);
    if (best == nullptr || load < least) {
      best = &node;
      least = load;
    }
  }
  return best;
}

Place StoreCoordinator::ForeignPlace(const View& view, std::string_view subject) const {
  Place place;
  // The view still shows this node as the holder until its thread has written the record.
  if (const auto heir = transits_.HeirOf(subject, now_())) {
    place.kind = Place::Kind::kElsewhere;
    place.node = *heir;
    return place;
  }
  if (transits_.IsExpected(subject, now_())) {
    place.why = "the subject is on its way to this node";
    return place;
  }
  const auto lease = view.foreign.find(subject);
  if (lease == view.foreign.end()) {
    place.why = view.fault.empty() ? "no node serves the subject" : view.fault;
    return place;
  }
  place.epoch = lease->second.epoch;
  const auto node = view.others.find(lease->second.node);
  if (node != view.others.end() && node->second.draining) {
    place.why = "the node '" + lease->second.node + "' is draining";
  } else if (node != view.others.end()) {
    place.kind = Place::Kind::kElsewhere;
    place.node = node->second.address;
  } else {
    place.why = "the node '" + lease->second.node + "' holds the subject, and is not there";
  }
  return place;
}

Place StoreCoordinator::Elsewhere(std::string_view subject) const {
  return ForeignPlace(*view(), subject);
}

Place StoreCoordinator::Find(std::string_view subject, Time now) const {
  const auto seen = view();
  const auto own = seen->own.find(subject);
  if (own == seen->own.end() || now >= own->second.until || transits_.HeirOf(subject, now_())) {
    return ForeignPlace(*seen, subject);
  }
  Place place;
  place.kind = Place::Kind::kHere;
  place.epoch = own->second.epoch;
  place.until = own->second.until;
  place.node = self_;
  return place;
}

Place StoreCoordinator::Propose(std::string_view subject, Time now) const {
  Place place = Find(subject, now);
  if (place.kind != Place::Kind::kNowhere) return place;
  const auto seen = view();
  if (seen->foreign.contains(subject)) return place;
  const bool draining = is_draining();
  const Announcement* const other = RoomElsewhere(*seen);
  const auto own = static_cast<int>(seen->own.size());
  const bool has_room = !draining && seen->may_take && HasRoomFor(*seen, subject);
  // Offered to the emptier node.
  const bool is_emptier =
      other == nullptr || LoadOf(own, capacity_) <= LoadOf(other->subjects, other->capacity);
  if (has_room && is_emptier) {
    place.kind = Place::Kind::kHere;
    place.node = self_;
  } else if (other != nullptr) {
    place.kind = Place::Kind::kElsewhere;
    place.node = other->address;
  } else if (seen->fault.empty()) {
    place.why = draining ? "this node is draining, and no other node has room"
                         : "this node is full, and no other node has room";
  }
  return place;
}

// A subject stays where it is offered, if there is room: its sender has chosen this node.
Place StoreCoordinator::Ask(std::string_view subject, Time now) {
  Place place = Find(subject, now);
  if (place.kind == Place::Kind::kHere) return place;
  if (place.kind == Place::Kind::kElsewhere) {
    Request(subject, false);
    return place;
  }
  const auto seen = view();
  const bool draining = is_draining();
  const bool has_room = !draining && HasRoomFor(*seen, subject);
  const bool is_held = seen->foreign.contains(subject) || transits_.IsExpected(subject, now_());
  const bool waits =
      seen->reachable && !seen->has_rival && (is_held || RoomElsewhere(*seen) == nullptr);
  if (!has_room || !(seen->may_take || waits)) return Propose(subject, now);
  Request(subject, true);
  place.kind = Place::Kind::kPending;
  return place;
}

// Not Propose(), which names this node while it holds the lease.
Place StoreCoordinator::Successor(std::string_view subject,
                                  const std::set<std::string>& without) const {
  const auto seen = view();
  Place place = ForeignPlace(*seen, subject);
  if (place.kind == Place::Kind::kElsewhere) return place;
  if (const Announcement* const other = RoomElsewhere(*seen, without); other != nullptr) {
    place.kind = Place::Kind::kElsewhere;
    place.node = other->address;
  } else {
    place.why = seen->fault.empty() ? "no other node has room" : seen->fault;
  }
  return place;
}

std::vector<NodeAddress> StoreCoordinator::Others() const {
  const auto seen = view();
  std::vector<NodeAddress> others;
  for (const bool draining : {false, true}) {
    for (const auto& [name, node] : seen->others) {
      if (node.draining == draining) others.push_back(node.address);
    }
  }
  return others;
}

std::string StoreCoordinator::Fault(Time /*now*/) const { return view()->fault; }

ClusterState StoreCoordinator::State(Time now) const {
  const auto seen = view();
  ClusterState state;
  state.fault = seen->fault;
  state.nodes.push_back({.address = self_,
                         .subjects = static_cast<int>(seen->own.size()),
                         .capacity = capacity_,
                         .draining = is_draining(),
                         .self = true});
  for (const auto& [name, node] : seen->others) {
    state.nodes.push_back({.address = node.address,
                           .subjects = node.subjects,
                           .capacity = node.capacity,
                           .draining = node.draining,
                           .self = false});
  }
  for (const auto& [subject, serving] : seen->own) {
    if (now < serving.until) state.subjects.push_back({subject, self_.name, serving.epoch});
  }
  for (const auto& [subject, lease] : seen->foreign) {
    state.subjects.push_back({subject, lease.node, lease.epoch});
  }
  return state;
}

}  // namespace furrow::server
