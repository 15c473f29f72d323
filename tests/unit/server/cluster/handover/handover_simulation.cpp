// SPDX-License-Identifier: Apache-2.0
#include "handover_simulation.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "handover_receiver.h"
#include "protocol/framing/fragment.h"
#include "server/cluster/store/store_coordinator.h"
#include "simulated_node.h"
#include "tests/unit/protocol/secure/secure_testing.h"
#include "tests/unit/server/cluster/event_queue.h"
#include "tests/unit/server/cluster/simulated_machine.h"

namespace furrow::server::testing {
namespace {

using Ms = std::int64_t;
using std::chrono::milliseconds;

constexpr Ms kTickMs = 100;
constexpr Ms kEarlyTickMs = 400;  // before anything happens
constexpr Ms kHurriedTickMs = 20;
constexpr Ms kMoverMs = 20;  // while it waits; it also looks after each event
constexpr Ms kHelloMs = 50;
constexpr Ms kPoseMs = 60;
constexpr Ms kOfferMs = 100;
constexpr Ms kNextNodeMs = 2000;  // after this time without an answer, the publisher goes on
constexpr Ms kUnixMs = 1'700'000'000'000;
constexpr Ms kForgottenMs = 3000;  // a node that does not announce itself
constexpr Ms kFarewellMs = StoreCoordinator::kFarewell / milliseconds(1);
constexpr Ms kRestartMs = 600;
constexpr Ms kBeginMs = 4700;  // by then, the first node serves the subject
constexpr Ms kFaultsMs = 1000;
constexpr Ms kMostMs = 12'000;  // after the last fault
constexpr std::size_t kMaxBacklog = 64;

class Simulation : public NodeSurroundings {
 public:
  Simulation(std::uint64_t seed, bool strict) : random_(seed << 20), strict_(strict) {
    for (int i = 0; i < kNodes; ++i) nodes_[i].links.emplace(this, i);
  }

  HandoverOutcome Run(unsigned faults, int most_faults) {
    Settle();
    At(kBeginMs, [this] { Drain(0); });
    PlanFaults(faults, most_faults);
    At(kBeginMs - 200, [this] { Publish(); });
    while (out_.fault.empty() && !HasSettled() && events_.Run(receiver_.last_fault() + kMostMs)) {
    }
    receiver_.NoteGap(now());
    if (out_.fault.empty() && !HasSettled()) Fail("the subject is not served at the end");
    return out_;
  }

 private:
  // The conversations of one node.
  struct Links : NodeLinks {
    Links(Simulation* simulation, int index) : world(simulation), from(index) {}
    void Open(const NodeAddress& node, Time patience) override {
      const int to = IndexOf(node.name);
      ++session[to];
      connected[to] = false;
      const Ms end = world->now() + patience / milliseconds(1);
      world->SayHello(from, to, session[to], end);
    }
    void Send(const std::string& node, std::span<const std::uint8_t> message) override {
      if (const int to = IndexOf(node); connected[to]) world->SendState(from, to, message);
    }
    [[nodiscard]] bool HasFailed(const std::string& /*node*/) const override { return false; }
    void Close(const std::string& node) override {
      connected[IndexOf(node)] = false;
      ++session[IndexOf(node)];
    }
    Simulation* world;
    int from;
    std::array<std::uint64_t, kNodes> session{};
    std::array<bool, kNodes> connected{};
    std::uint32_t next_message = 0;
  };
  struct Node : SimulatedMachine {
    std::optional<Links> links;
    std::unique_ptr<SimulatedNode> node;  // null: it does not run
    [[nodiscard]] bool runs() const { return node != nullptr; }
    std::unique_ptr<protocol::Reassembler> reassembler;
    Ms announced_at = -kForgottenMs;
    bool announced_draining = false;
    bool announced_room = false;
    bool full = false;
    bool moves = false;  // its Handovers run
    bool ends = false;
  };

  [[nodiscard]] Ms now() const { return events_.now(); }
  Ms Number(Ms least, Ms most) {
    return least + static_cast<Ms>(random_.Below(static_cast<std::uint64_t>(most - least + 1)));
  }
  bool Chance(Ms percent) { return Number(1, 100) <= percent; }
  // Mostly short, sometimes long enough to be overtaken by everything else.
  Ms Delay() {
    if (!begun_) return 1;
    return Number(0, 19) == 0 ? Number(50, 600) : Number(1, 10);
  }

  void At(Ms time, std::function<void()> action) { events_.At(time, std::move(action)); }
  template <class Action>
  void OnNode(int index, Ms time, Action action) {
    RunOnNode(
        &events_, &nodes_[index], time, [this] { return Number(0, 3); }, std::move(action));
  }
  Time Clock(const Node& node) const { return node.Clock(now()); }
  bool Hears(const Node& node) const {
    return now() >= node.cut_until && now() >= store_down_until_;
  }

  // Of NodeSurroundings.
  [[nodiscard]] bool IsThere(int asker, int node) const override {
    return !nodes_[asker].told || now() - nodes_[node].announced_at < kForgottenMs;
  }
  [[nodiscard]] bool IsDraining(int node) const override { return nodes_[node].announced_draining; }
  [[nodiscard]] bool HasRoom(int node) const override { return nodes_[node].announced_room; }
  [[nodiscard]] std::uint64_t RunOf(int node) const override { return nodes_[node].life; }
  void SendPublisher(int from, int to) override {
    if (!PublisherHears(from)) return;
    At(now() + Delay(), [this, from, to] {
      if (target_ != from) return;
      GoTo(to);
    });
  }

  // All nodes know the store, and the first one holds the lease.
  void Settle() {
    for (int i = 0; i < kNodes; ++i) Boot(i);
    At(kBeginMs - 900, [this] { (void)nodes_[0].node->Offer(Clock(nodes_[0])); });
    while (events_.Run(kBeginMs - 201)) {
    }
    if (nodes_[0].node->Offer(Clock(nodes_[0])) != SimulatedNode::Answer::kAccepted) {
      Fail("the first node does not get the subject");
    }
    publishing_ = true;
    target_ = 0;
    begun_ = std::pair{0, nodes_[0].life};
    out_.cold = 0;
    heard_ = offered_ = now();
    receiver_.Start(now());
  }

  void Boot(int index) {
    Node& node = nodes_[index];
    const Ms origin = now() - Number(0, 100'000);
    node.Start(now(), origin, Number(-10, 10));
    node.node = std::make_unique<SimulatedNode>(index, node.life, strict_, this, &*node.links);
    node.node->set_full(node.full);
    node.reassembler = std::make_unique<protocol::Reassembler>();
    node.links->connected.fill(false);
    node.wall_offset = Number(-20'000, 20'000);
    node.moves = node.ends = false;
    OnNode(index, now() + Number(0, kTickMs), [this, index](Node& each) { Tick(index, each); });
  }

  void Tick(int index, Node& node) {
    const bool hears = Hears(node);
    LeaseKeeper& keeper = node.node->keeper();
    const Time clock = Clock(node);
    node.Notice(hears, now(), &keeper);
    node.node->TakeRequests();
    if (node.AsksForListing(keeper, now(), kTickMs)) RequestListing(index, node);
    for (LeaseWrite& write : keeper.Tick(clock, kUnixMs + now() + node.wall_offset)) {
      SendWrite(index, node, std::move(write));
    }
    if (hears) {
      node.announced_at = now();
      node.announced_draining = node.node->draining();
      node.announced_room = keeper.MayTake(clock) && !node.full;
    }
    node.node->Publish(clock);
    if (!node.ends) LookAtHub(index, node, clock);
    CheckServing();
    const bool is_early = now() < kBeginMs - 900;
    OnNode(index,
           now() + (is_early                    ? kEarlyTickMs
                    : node.node->hurries(clock) ? kHurriedTickMs
                                                : kTickMs),
           [this, index](Node& each) { Tick(index, each); });
  }

  void LookAtHub(int index, Node& node, Time clock) {
    node.node->Refresh(clock);
    if (node.node->AsksAgain(clock)) {
      At(now() + Delay(), [this, index] {
        if (target_ == index && PublisherHears(index)) Offer();
      });
    }
  }

  void RequestListing(int index, Node& node) {
    const std::uint64_t number = node.AskForListing(now());
    if (!Hears(node)) return;
    At(now() + Delay(), [this, index, number] {
      if (!Hears(nodes_[index])) return;
      OnNode(index, now() + Delay(), [this, record = record_, number](Node& each) {
        if (!Hears(each) || !each.TakeListing(number)) return;
        LeaseListing listing{1, {}};
        if (record.revision != 0) listing.entries.push_back(record);
        each.node->keeper().OnListing(listing, Clock(each));
      });
    });
  }

  void SendWrite(int index, Node& node, LeaseWrite write) {
    if (!Hears(node)) return;
    At(now() + Delay(), [this, index, life = node.life, write = std::move(write)] {
      if (now() < nodes_[index].cut_until || now() < store_down_until_) return;
      const bool done = record_.revision == write.expected;
      if (done) {
        const bool is_heir = !write.lease.node.empty() && IndexOf(write.lease.node) != index;
        out_.handovers += is_heir ? 1 : 0;
        record_ = {write.subject, write.lease, record_.revision + 1};
        Hint();
      }
      if (nodes_[index].life != life) return;
      OnNode(index, now() + Delay(),
             [this, id = write.id, done, revision = record_.revision](Node& each) {
               if (!Hears(each)) return;
               each.node->keeper().OnWritten(kSubject, id,
                                             done ? WriteResult::kDone : WriteResult::kRefused,
                                             revision, Clock(each));
             });
    });
  }

  // Watchers hear of most changes, in any order.
  void Hint() {
    for (int i = 0; i < kNodes; ++i) {
      if (nodes_[i].node == nullptr || Number(0, 9) == 0) continue;
      OnNode(i, now() + Delay(), [this, entry = record_](Node& each) {
        if (Hears(each)) each.node->keeper().OnEntry(entry, Clock(each));
      });
    }
  }

  // True if a datagram of one node reaches the other one.
  bool LinkHolds(int from, int to) {
    if (now() < link_cut_until_[from][to]) return false;
    return now() >= loss_until_ || !Chance(40);
  }
  // How often it arrives, in bad times.
  int Copies() { return now() < loss_until_ && Chance(30) ? 2 : 1; }
  Ms LinkDelay() { return now() < loss_until_ ? Number(1, 300) : Delay(); }

  // Each attempt is a datagram there and one back.
  void SayHello(int from, int to, std::uint64_t session, Ms end) {
    Links& links = *nodes_[from].links;
    if (links.session[to] != session || links.connected[to]) return;
    if (now() >= end) return EndHello(from, to, session, false);
    if (LinkHolds(from, to)) {
      OnNode(to, now() + LinkDelay(), [this, from, to, session](Node&) {
        if (!LinkHolds(to, from)) return;
        At(now() + LinkDelay(), [this, from, to, session] { EndHello(from, to, session, true); });
      });
    }
    OnNode(from, now() + kHelloMs,
           [this, from, to, session, end](Node&) { SayHello(from, to, session, end); });
  }

  void EndHello(int from, int to, std::uint64_t session, bool connects) {
    OnNode(from, now(), [this, to, session, connects](Node& each) {
      if (each.links->session[to] != session || each.links->connected[to]) return;
      each.links->connected[to] = connects;
      each.node->handovers().OnLink(
          NameOf(to), connects ? Status() : Status(StatusCode::kUnavailable, "does not answer"));
      if (!connects) ++out_.passed_over;
      Move(each);
    });
  }

  void SendState(int from, int to, std::span<const std::uint8_t> message) {
    Links& links = *nodes_[from].links;
    std::vector<std::uint8_t> bytes(message.begin(), message.end());
    protocol::Envelope envelope;
    if (protocol::ReadEnvelope(bytes, envelope) != protocol::EnvelopeStatus::kOk) {
      return Fail("a state cannot be read");
    }
    // As NodeLink does.
    const std::uint64_t session = links.session[to] * kNodes + from + 1;
    envelope.header.session = session;
    protocol::WriteEnvelope(envelope, std::span(bytes).first<protocol::kEnvelopeBytes>());
    const std::uint32_t id = links.next_message++;
    std::array<std::uint8_t, protocol::kMaxDatagramBytes> out;
    for (std::size_t i = 0; i < protocol::NumDatagrams(bytes.size()); ++i) {
      const std::size_t size = protocol::WriteDatagram(bytes, id, i, out);
      if (!LinkHolds(from, to)) continue;
      for (int copies = Copies(); copies > 0; --copies) {
        OnNode(to, now() + LinkDelay(),
               [this, from, to, datagram = std::vector(out.begin(), out.begin() + size)](
                   Node& each) { OnDatagram(from, to, each, datagram); });
      }
    }
  }

  void OnDatagram(int from, int to, Node& node, const std::vector<std::uint8_t>& datagram) {
    std::span<const std::uint8_t> message;
    const auto status = node.reassembler->Push({.peer = static_cast<std::uint64_t>(from)}, datagram,
                                               Clock(node) / std::chrono::microseconds(1), message);
    if (status != protocol::FragmentStatus::kWhole &&
        status != protocol::FragmentStatus::kComplete) {
      return;
    }
    protocol::MessageView view;
    protocol::SubjectState state;
    if (protocol::OpenMessage(message, view) != protocol::DecodeStatus::kOk ||
        protocol::Decode(view, state) != protocol::DecodeStatus::kOk) {
      return Fail("a state arrived damaged");
    }
    if (node.ends) return;
    const std::string why = node.node->Receive(state, view, Clock(node));
    if (!LinkHolds(to, from)) return;
    const std::uint64_t session = view.header.session;
    for (int copies = Copies(); copies > 0; --copies) {
      OnNode(from, now() + LinkDelay(),
             [this, from, to, session, number = view.header.sequence, why](Node& each) {
               Links& links = *each.links;
               if (links.session[to] * kNodes + from + 1 != session) return;
               if (!why.empty()) ++out_.passed_over;
               each.node->handovers().OnAnswer(NameOf(to), number, why.empty(), why);
               Move(each);
             });
    }
  }

  void Drain(int index) {
    OnNode(index, now(), [this, index](Node& node) {
      if (node.moves || node.ends) return;
      // Somebody must be left.
      int others = 0;
      for (int i = 0; i < kNodes; ++i) {
        const bool stays = nodes_[i].node != nullptr && !nodes_[i].moves && !nodes_[i].ends;
        others += i != index && stays ? 1 : 0;
      }
      if (others == 0) return;
      if (std::exchange(drained_, true)) Count(kSecondDrain);
      node.moves = true;
      node.node->handovers().Begin();
      Move(node);
      MoveLater(index);
    });
  }

  void Move(Node& node) {
    if (!node.moves || node.ends) return;
    node.node->handovers().Tick(Clock(node));
    if (!node.node->handovers().running()) End(node);
  }
  void MoveLater(int index) {
    OnNode(index, now() + kMoverMs, [this, index](Node& node) {
      Move(node);
      if (node.moves && !node.ends) MoveLater(index);
    });
  }

  // The daemon says goodbye, its coordinator gives back what it has, and it starts again later.
  void End(Node& node) {
    const int index = static_cast<int>(&node - nodes_.data());
    node.ends = true;
    node.node->SendAllAway(Clock(node));
    OnNode(index, now() + 20, [this, index, end = now() + kFarewellMs](Node& each) {
      each.node->keeper().ReleaseAll();
      Farewell(index, end);
    });
  }

  void Farewell(int index, Ms end) {
    // Somebody starts it again.
    receiver_.NoteFault(now() + kRestartMs);
    OnNode(index, now() + kHurriedTickMs, [this, index, end](Node& node) {
      const LeaseKeeper& keeper = node.node->keeper();
      if (keeper.holds_any() && keeper.reachable() && now() < end) return Farewell(index, end);
      node.node.reset();
      node.moves = node.ends = false;
      ++node.life;
      At(now() + Number(100, kRestartMs), [this, index] {
        if (nodes_[index].node == nullptr) Boot(index);
      });
    });
  }

  bool PublisherHears(int node) const { return now() >= publisher_away_until_[node]; }

  void GoTo(int node) {
    target_ = node;
    publishing_ = false;
    heard_ = now();
    Offer();
  }

  void Offer() {
    offered_ = now();
    const int target = target_;
    if (!PublisherHears(target)) return;
    OnNode(target, now() + Delay(), [this, target](Node& node) {
      if (node.ends) return;
      const auto answer = node.node->Offer(Clock(node));
      if (answer == SimulatedNode::Answer::kAccepted) NoteBegin(node);
      if (answer == SimulatedNode::Answer::kSentAway || !PublisherHears(target)) return;
      At(now() + Delay(), [this, target, answer] {
        if (target_ != target) return;
        if (answer != SimulatedNode::Answer::kRefused) heard_ = now();
        if (answer == SimulatedNode::Answer::kAccepted && !std::exchange(publishing_, true)) {
          SendBacklog();
        }
      });
    });
  }

  void NoteBegin(const Node& node) {
    const int index = static_cast<int>(&node - nodes_.data());
    const std::pair begun{index, node.life};
    if (std::exchange(begun_, begun) == begun) return;
    node.node->resumed_at() ? ++out_.warm : ++out_.cold;
    if (!node.node->state_is_whole()) Fail("a state did not arrive whole");
    if (!node.node->state_is_newest()) Fail("a node went on from an old state");
  }

  // Poses that were made while nobody took them.
  void SendBacklog() {
    for (const std::uint32_t sequence : std::exchange(backlog_, {})) SendPose(sequence);
  }

  void Publish() {
    const std::uint32_t sequence = ++sequence_;
    if (now() - heard_ > kNextNodeMs) GoTo(static_cast<int>(Number(0, kNodes - 1)));
    if (publishing_) {
      SendPose(sequence);
    } else {
      backlog_.push_back(sequence);
      if (backlog_.size() > kMaxBacklog) backlog_.pop_front();
      if (now() - offered_ >= kOfferMs) Offer();
    }
    At(now() + kPoseMs, [this] { Publish(); });
  }

  void SendPose(std::uint32_t sequence) {
    const int target = target_;
    if (!PublisherHears(target)) return;
    OnNode(target, now() + Delay(), [this, target, sequence](Node& node) {
      if (node.ends) return;
      const bool is_here = node.node->is_here();
      if (PublisherHears(target) && target_ == target) {
        if (is_here) {
          heard_ = now();
        } else if (publishing_) {  // it asks for the offer
          publishing_ = false;
        }
      }
      const auto used = node.node->UsePose(sequence, Clock(node));
      if (!used) return;
      NoteServing(target, used->epoch);
      At(now() + Delay(), [this, used = *used, sequence] {
        receiver_.OnFrame(used.epoch, used.warm, sequence, now());
      });
    });
  }

  void NoteServing(int index, std::uint64_t epoch) {
    receiver_.NoteServing({index, nodes_[index].life}, epoch, now());
  }

  void CheckServing() {
    int serving = 0;
    for (int i = 0; i < kNodes; ++i) {
      const Node& node = nodes_[i];
      if (node.node == nullptr || node.frozen_until > now()) continue;
      const auto found = node.node->keeper().ServingOf(kSubject, Clock(node));
      if (!found) continue;
      ++serving;
      NoteServing(i, found->epoch);
    }
    if (serving < 2) return;
    ++out_.overlaps;
    if (strict_) Fail("two nodes served at one time");
  }

  [[nodiscard]] bool HasSettled() const {
    for (const Node& node : nodes_) {
      if (node.moves || node.ends) return false;
    }
    return receiver_.HasSettled(now());
  }

  void PlanFaults(unsigned faults, int most) {
    std::array<HandoverFault, kHandoverFaultKinds> kinds{};
    Ms count = 0;
    for (unsigned kind = 1; kind < kAllHandoverFaults; kind *= 2) {
      if ((faults & kind) != 0) kinds[count++] = static_cast<HandoverFault>(kind);
    }
    if (count == 0) return;
    for (Ms left = Number(1, most); left > 0; --left) {
      const HandoverFault kind = kinds[Number(0, count - 1)];
      // Half of them meet the hand-over itself.
      const Ms begin = kBeginMs + (Number(0, 1) == 0 ? Number(-50, 60) : Number(0, kFaultsMs));
      const Ms length = Number(0, 3) == 0 ? Number(1000, 5000) : Number(50, 1000);
      receiver_.NoteFault(begin + length);
      At(begin, [this, kind, length] { Inflict(kind, length); });
    }
  }

  int Victim() {
    switch (Number(0, 3)) {
      case 0: return target_;
      case 1: return 1;  // the first heir
      default: return static_cast<int>(Number(0, kNodes - 1));
    }
  }

  // False: the fault changes nothing, because the node does not run or does not move its subject.
  // Drain() counts its own.
  static bool IsFelt(HandoverFault kind, const Node& node) {
    if (kind == kSecondDrain) return false;
    if (kind == kStoreEnd || kind == kLinkLoss) return true;
    return node.node != nullptr && (kind != kShortTime || node.moves);
  }
  void Count(HandoverFault kind) {
    ++out_.faults[static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(kind)))];
  }

  void Inflict(HandoverFault kind, Ms length) {
    const int index = Victim();
    Node& node = nodes_[index];
    const Ms end = now() + length;
    if (IsFelt(kind, node)) Count(kind);
    switch (kind) {
      case kNodeCrash:
        node.node.reset();
        node.moves = node.ends = false;
        ++node.life;
        At(end, [this, index] {
          if (nodes_[index].node == nullptr) Boot(index);
        });
        break;
      case kNodeFreeze: node.frozen_until = std::max(node.frozen_until, end); break;
      case kStoreCut: node.cut_until = std::max(node.cut_until, end); break;
      case kStoreEnd: store_down_until_ = std::max(store_down_until_, end); break;
      case kLinkCut: {
        const int other = (index + static_cast<int>(Number(1, kNodes - 1))) % kNodes;
        link_cut_until_[index][other] = end;
        if (Number(0, 1) == 0) link_cut_until_[other][index] = end;
        break;
      }
      case kLinkLoss: loss_until_ = std::max(loss_until_, end); break;
      case kNodeFull:
        node.full = true;
        if (node.node != nullptr) node.node->set_full(true);
        At(end, [this, index] {
          nodes_[index].full = false;
          if (nodes_[index].node != nullptr) nodes_[index].node->set_full(false);
        });
        break;
      case kPublisherAway: publisher_away_until_[index] = end; break;
      case kSecondDrain: Drain(index); break;
      case kShortTime:
        if (node.moves && node.node != nullptr)
          node.node->handovers().EndBy(Clock(node) + milliseconds(length));
        break;
      case kAllHandoverFaults: break;
    }
  }

  void Fail(std::string fault) { receiver_.Fail(std::move(fault), now()); }

  protocol::secure::test::RepeatableRandom random_;
  const bool strict_;
  EventQueue events_;
  std::array<Node, kNodes> nodes_;
  LeaseEntry record_{kSubject, {}, 0};
  Ms store_down_until_ = 0;
  Ms loss_until_ = 0;
  std::array<std::array<Ms, kNodes>, kNodes> link_cut_until_{};
  std::array<Ms, kNodes> publisher_away_until_{};
  bool drained_ = false;  // once

  // The publisher.
  int target_ = 0;
  bool publishing_ = false;
  Ms heard_ = 0;
  Ms offered_ = 0;
  std::uint32_t sequence_ = 0;
  std::deque<std::uint32_t> backlog_;

  HandoverReceiver receiver_{kBeginMs};
  HandoverOutcome& out_ = receiver_.outcome();
  std::optional<HandoverReceiver::Owner> begun_;  // who served last
};

}  // namespace

HandoverOutcome& HandoverOutcome::operator+=(const HandoverOutcome& other) {
  gap_ms = std::max(gap_ms, other.gap_ms);
  settled_ms = std::max(settled_ms, other.settled_ms);
  handovers += other.handovers;
  warm += other.warm;
  cold += other.cold;
  passed_over += other.passed_over;
  frames += other.frames;
  fenced += other.fenced;
  overlaps += other.overlaps;
  for (std::size_t i = 0; i < faults.size(); ++i) faults[i] += other.faults[i];
  return *this;
}

HandoverOutcome SimulateHandovers(std::uint64_t seed, bool strict, unsigned faults,
                                  int most_faults) {
  return Simulation(seed, strict).Run(faults, most_faults);
}

}  // namespace furrow::server::testing
