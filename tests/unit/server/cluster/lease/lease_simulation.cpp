// SPDX-License-Identifier: Apache-2.0
#include "lease_simulation.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "server/cluster/lease/lease_keeper.h"
#include "tests/unit/server/cluster/event_queue.h"
#include "tests/unit/server/cluster/simulated_machine.h"

namespace furrow::server::testing {
namespace {

using Ms = std::int64_t;

constexpr int kNodes = 3;
constexpr Ms kTickMs = 100;
constexpr Ms kPoseMs = 100;
constexpr Ms kFaultsBeginMs = 6000;
constexpr Ms kFaultsEndMs = 14'000;
constexpr Ms kEndMs = 32'000;
constexpr Ms kUnixMs = 1'700'000'000'000;
constexpr char kSubject[] = "ada";

class Simulation {
 public:
  Simulation(std::uint64_t seed, bool strict) : random_(seed), strict_(strict) {
    emptied_runs_ = Number(0, 1) == 1;
    for (int i = 0; i < kNodes; ++i) Boot(i);
  }

  LeaseOutcome Run(unsigned faults, int most_faults) {
    PlanFaults(faults, most_faults);
    At(0, [this] { Publish(); });
    while (out_.fault.empty() && events_.Run(kEndMs)) {
    }
    NoteGap(kEndMs);
    if (out_.fault.empty() && last_used_ < kEndMs - 1500) {
      out_.fault = "the subject is not served " + std::to_string(kEndMs - last_fault_) +
                   " ms after the last fault";
    }
    out_.epochs = owners_.size();
    return out_;
  }

 private:
  struct Node : SimulatedMachine {
    std::unique_ptr<LeaseKeeper> keeper;  // null: crashed
    [[nodiscard]] bool runs() const { return keeper != nullptr; }
  };

  Ms Number(Ms least, Ms most) { return std::uniform_int_distribution<Ms>(least, most)(random_); }
  // Mostly short, sometimes long enough to be overtaken by everything else.
  Ms Delay() { return Number(0, 19) == 0 ? Number(50, 600) : Number(1, 30); }

  [[nodiscard]] Ms now_ms() const { return events_.now(); }
  void At(Ms time, std::function<void()> action) { events_.At(time, std::move(action)); }
  template <class Action>
  void OnNode(int index, Ms time, Action action) {
    RunOnNode(
        &events_, &nodes_[index], time, [this] { return Number(0, 3); }, std::move(action));
  }

  Time Clock(const Node& node) const { return node.Clock(now_ms()); }
  Ms Wall(const Node& node) const { return kUnixMs + now_ms() + node.wall_offset; }
  bool Hears(const Node& node) const {
    return now_ms() >= node.cut_until && now_ms() >= store_down_until_;
  }

  void Boot(int index) {
    Node& node = nodes_[index];
    node.keeper = std::make_unique<LeaseKeeper>(std::string(1, static_cast<char>('a' + index)),
                                                Number(1, 1'000'000'000), strict_);
    const Ms origin = now_ms() - Number(0, 100'000);
    node.Start(now_ms(), origin, Number(-10, 10));
    OnNode(index, now_ms() + Number(0, kTickMs), [this, index](Node& each) { Tick(index, each); });
  }

  void Tick(int index, Node& node) {
    node.Notice(Hears(node), now_ms(), node.keeper.get());
    if (node.AsksForListing(*node.keeper, now_ms(), kTickMs)) RequestListing(index, node);
    for (LeaseWrite& write : node.keeper->Tick(Clock(node), Wall(node))) {
      SendWrite(index, node, std::move(write));
    }
    CheckServing();
    OnNode(index, now_ms() + kTickMs, [this, index](Node& each) { Tick(index, each); });
  }

  void RequestListing(int index, Node& node) {
    const std::uint64_t number = node.AskForListing(now_ms());
    if (!Hears(node)) return;
    At(now_ms() + Delay(), [this, index, number] {
      if (!Hears(nodes_[index])) return;
      LeaseListing listing{incarnation_, {}};
      for (const auto& [subject, entry] : store_) listing.entries.push_back(entry);
      OnNode(index, now_ms() + Delay(), [this, listing, number](Node& each) {
        if (Hears(each) && each.TakeListing(number)) each.keeper->OnListing(listing, Clock(each));
      });
    });
  }

  void SendWrite(int index, Node& node, LeaseWrite write) {
    if (!Hears(node)) return;
    const std::uint64_t life = node.life;
    At(now_ms() + Delay(), [this, index, life, write = std::move(write)] {
      if (now_ms() < nodes_[index].cut_until || now_ms() < store_down_until_) return;
      LeaseEntry& entry = store_[write.subject];
      const bool done = entry.revision == write.expected;
      if (done) {
        entry = {write.subject, write.lease, ++revision_};
        Hint(entry);
      }
      const Revision revision = entry.revision;
      if (entry.revision == 0) store_.erase(write.subject);
      if (nodes_[index].life != life) return;
      OnNode(index, now_ms() + Delay(),
             [this, subject = write.subject, id = write.id, done, revision](Node& each) {
               if (!Hears(each)) return;
               each.keeper->OnWritten(subject, id,
                                      done ? WriteResult::kDone : WriteResult::kRefused, revision,
                                      Clock(each));
             });
    });
  }

  // Watchers hear of most changes, in any order.
  void Hint(const LeaseEntry& entry) {
    for (int i = 0; i < kNodes; ++i) {
      if (Number(0, 9) == 0 || nodes_[i].keeper == nullptr) continue;
      OnNode(i, now_ms() + Delay(), [this, entry, incarnation = incarnation_](Node& each) {
        if (Hears(each) && incarnation == incarnation_) {
          each.keeper->OnEntry(entry, Clock(each));
        }
      });
    }
  }

  // One publisher sends to one node, and goes on to the next one if that does not answer.
  void Publish() {
    if (now_ms() - answered_ > 500) {
      answered_ = now_ms();
      target_ = static_cast<int>(Number(0, kNodes - 1));
    }
    const std::uint64_t sequence = next_sequence_++;
    const int target = target_;
    if (now_ms() >= publisher_cut_until_[target]) {
      OnNode(target, now_ms() + Delay(),
             [this, target, sequence](Node& node) { OnPose(target, node, sequence); });
    }
    // Somebody else offers the subject elsewhere now and then.
    if (Number(0, 19) == 0) {
      OnNode(static_cast<int>(Number(0, kNodes - 1)), now_ms(), [this](Node& node) {
        if (node.keeper->HolderOf(kSubject, Clock(node)).empty()) node.keeper->Want(kSubject);
      });
    }
    At(now_ms() + kPoseMs, [this] { Publish(); });
  }

  void OnPose(int index, Node& node, std::uint64_t sequence) {
    const Time now = Clock(node);
    const std::string_view holder = node.keeper->HolderOf(kSubject, now);
    if (!holder.empty()) {
      node.keeper->Release(kSubject);
      At(now_ms() + Delay(), [this, index, next = holder[0] - 'a'] {
        if (target_ != index) return;
        target_ = next;
        answered_ = now_ms();
      });
      return;
    }
    node.keeper->Want(kSubject);
    At(now_ms() + Delay(), [this, index] {
      if (target_ == index) answered_ = now_ms();
    });
    const auto serving = node.keeper->ServingOf(kSubject, now);
    if (!serving) return;
    NoteServing(index, serving->epoch);
    At(now_ms() + Delay(), [this, epoch = serving->epoch, sequence] { OnFrame(epoch, sequence); });
  }

  void NoteServing(int index, std::uint64_t epoch) {
    // A node in another life is another node.
    const std::pair<int, std::uint64_t> owner{index, nodes_[index].life};
    const auto [known, added] = owners_.emplace(epoch, owner);
    if (!added && known->second != owner) {
      Fail("two nodes served epoch " + std::to_string(epoch));
    }
  }

  void CheckServing() {
    int serving = 0;
    for (int i = 0; i < kNodes; ++i) {
      const Node& node = nodes_[i];
      if (node.keeper == nullptr || node.frozen_until > now_ms()) continue;
      const auto found = node.keeper->ServingOf(kSubject, Clock(node));
      if (!found) continue;
      ++serving;
      NoteServing(i, found->epoch);
    }
    if (serving < 2) return;
    ++out_.overlaps;
    if (strict_) Fail("two nodes served at one time");
  }

  void OnFrame(std::uint64_t epoch, std::uint64_t sequence) {
    const std::pair frame(epoch, sequence);
    if (frame <= newest_) {
      if (epoch < newest_.first) ++out_.fenced;
      return;
    }
    newest_ = frame;
    ++out_.frames;
    NoteGap(now_ms());
    last_used_ = now_ms();
  }

  void NoteGap(Ms now) {
    if (now < kFaultsBeginMs) return;
    out_.longest_ms = std::max(out_.longest_ms, now - std::max(last_used_, kFaultsBeginMs));
    if (now > last_fault_) {
      out_.settled_ms = std::max(out_.settled_ms, now - std::max(last_used_, last_fault_));
    }
  }

  void PlanFaults(unsigned faults, int most) {
    std::vector<LeaseFault> kinds;
    for (unsigned kind = 1; kind < kAllFaults; kind *= 2) {
      // Where the store and all memory of the nodes may be lost, clocks are about right.
      if ((faults & kind) == 0 || (kind == kStoreEmptied && !emptied_runs_)) continue;
      kinds.push_back(static_cast<LeaseFault>(kind));
    }
    if (kinds.empty()) return;
    for (Ms count = Number(1, most); count > 0; --count) {
      const LeaseFault kind = kinds[Number(0, static_cast<Ms>(kinds.size()) - 1)];
      const Ms begin = Number(kFaultsBeginMs, kFaultsEndMs);
      const Ms length = Number(200, 6000);
      const int node = static_cast<int>(Number(0, kNodes - 1));
      last_fault_ = std::max(last_fault_, begin + length);
      At(begin, [this, kind, node, length] { Inflict(kind, node, length); });
    }
  }

  void Inflict(LeaseFault kind, int index, Ms length) {
    // Half of them hit the node that serves.
    if (Number(0, 1) == 0) index = target_;
    Node& node = nodes_[index];
    switch (kind) {
      case kCrash:
        node.keeper.reset();
        ++node.life;
        At(now_ms() + length, [this, index] {
          if (nodes_[index].keeper == nullptr) Boot(index);
        });
        break;
      case kFreeze: node.frozen_until = std::max(node.frozen_until, now_ms() + length); break;
      case kCut: node.cut_until = std::max(node.cut_until, now_ms() + length); break;
      case kStoreDown: store_down_until_ = std::max(store_down_until_, now_ms() + length); break;
      case kStoreEmptied:
        store_.clear();
        revision_ = 0;
        ++incarnation_;
        store_down_until_ =
            std::max(store_down_until_, now_ms() + (Number(0, 1) == 0 ? 0 : length));
        break;
      case kClockStep:
        node.wall_offset = emptied_runs_ ? Number(-1200, 1200) : Number(-40'000'000, 40'000'000);
        break;
      case kPublisherCut: publisher_cut_until_[index] = now_ms() + length; break;
      case kAllFaults: break;
    }
  }

  void Fail(std::string fault) {
    if (out_.fault.empty())
      out_.fault = std::move(fault) + " at " + std::to_string(now_ms()) + " ms";
  }

  std::mt19937_64 random_;
  const bool strict_;
  bool emptied_runs_ = false;
  EventQueue events_;
  std::array<Node, kNodes> nodes_;
  std::map<std::string, LeaseEntry> store_;
  Revision revision_ = 0;
  std::uint64_t incarnation_ = 1;
  Ms store_down_until_ = 0;
  Ms last_fault_ = 0;
  int target_ = 0;
  Ms answered_ = 0;
  std::array<Ms, kNodes> publisher_cut_until_{};
  std::uint64_t next_sequence_ = 0;
  std::map<std::uint64_t, std::pair<int, std::uint64_t>> owners_;
  std::pair<std::uint64_t, std::uint64_t> newest_{0, 0};
  Ms last_used_ = 0;
  LeaseOutcome out_;
};

}  // namespace

LeaseOutcome SimulateLeases(std::uint64_t seed, bool strict, unsigned faults, int most_faults) {
  return Simulation(seed, strict).Run(faults, most_faults);
}

}  // namespace furrow::server::testing
