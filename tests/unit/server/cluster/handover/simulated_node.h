// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/codec/codec.h"
#include "server/cluster/handover/handovers.h"
#include "server/cluster/lease/lease_keeper.h"
#include "server/session/subjects/arrivals.h"

namespace furrow::server::testing {

inline constexpr int kNodes = 3;
inline constexpr char kSubject[] = "ada";
inline constexpr std::uint64_t kPublisherSession = 77;

[[nodiscard]] std::string NameOf(int node);
// -1: an empty name.
[[nodiscard]] int IndexOf(std::string_view name);
// A long text that follows from the number, so that a state which is not whole is noticed.
[[nodiscard]] std::string TextOf(std::uint32_t newest);

// What a node knows of the others through the store's records, and how it reaches the publisher.
class NodeSurroundings {
 public:
  virtual ~NodeSurroundings() = default;
  [[nodiscard]] virtual bool IsThere(int asker, int node) const = 0;
  [[nodiscard]] virtual bool IsDraining(int node) const = 0;
  [[nodiscard]] virtual bool HasRoom(int node) const = 0;
  [[nodiscard]] virtual std::uint64_t RunOf(int node) const = 0;
  virtual void SendPublisher(int from, int to) = 0;
};

// What furrowd does with one subject, without sockets and clocks. The rules of StoreCoordinator,
// Places, Publishers, Dispatcher and Departures are written again, for one subject.
class SimulatedNode : public DepartingSubjects {
 public:
  SimulatedNode(int index, std::uint64_t run, bool strict, NodeSurroundings* others,
                NodeLinks* links);

  // The thread of the coordinator: at the beginning and at the end of StoreCoordinator::Step().
  void TakeRequests();
  void Publish(Time now);
  [[nodiscard]] bool hurries(Time now) const { return draining_ || now < expected_until_; }

  enum class Answer : std::uint8_t { kAccepted, kSentAway, kWaits, kRefused };
  Answer Offer(Time now);
  // True if the publisher shall repeat its offer, because the subject has its place by now.
  [[nodiscard]] bool AsksAgain(Time now);
  struct Used {
    std::uint64_t epoch = 0;
    bool warm = false;  // the node goes on with a state
  };
  [[nodiscard]] bool is_here() const { return is_here_; }
  // Nothing: the node does not use the pose.
  [[nodiscard]] std::optional<Used> UsePose(std::uint32_t sequence, Time now);
  // Another node sends a state. Why this one does not take it; empty: it does.
  [[nodiscard]] std::string Receive(const protocol::SubjectState& state,
                                    const protocol::MessageView& view, Time now);
  // Renews the place of the subject, and gives back places that nobody has used.
  void Refresh(Time now);
  // What a daemon does when the time of hand-overs is over.
  void SendAllAway(Time now);

  [[nodiscard]] bool may_take() const { return view_.may_take; }
  [[nodiscard]] bool draining() const { return draining_; }
  void set_full(bool full) { full_ = full; }
  // Of the last state that the node went on with.
  [[nodiscard]] const std::optional<std::uint32_t>& resumed_at() const { return resumed_at_; }
  [[nodiscard]] bool state_is_whole() const { return state_is_whole_; }
  // No later state had arrived before.
  [[nodiscard]] bool state_is_newest() const { return state_is_newest_; }
  [[nodiscard]] std::uint64_t run() const { return run_; }
  [[nodiscard]] LeaseKeeper& keeper() { return keeper_; }
  [[nodiscard]] Handovers& handovers() { return handovers_; }

  // Of DepartingSubjects.
  void TakeNothingNew() override { draining_ = true; }
  [[nodiscard]] std::vector<std::string> SubjectNames() override;
  [[nodiscard]] Place SuccessorOf(const std::string& subject, Time now,
                                  const std::set<std::string>& without) override;
  [[nodiscard]] bool WriteState(const std::string& subject, std::uint32_t number,
                                std::vector<std::uint8_t>& message) override;
  [[nodiscard]] Status HandOver(const std::string& subject, const NodeAddress& node,
                                std::uint32_t number, std::vector<std::uint8_t>& message,
                                Time now) override;

 private:
  struct View {
    std::optional<LeaseKeeper::Serving> own;
    int holder = -1;  // another node
    bool reachable = false;
    bool may_take = false;
  };
  [[nodiscard]] bool IsExpected(Time now) const { return now < expected_until_; }
  [[nodiscard]] bool HasHeir(Time now) const { return now < heir_until_; }
  [[nodiscard]] int RoomElsewhere(const std::set<std::string>& without) const;
  [[nodiscard]] Place Foreign(Time now) const;
  [[nodiscard]] Place Find(Time now) const;
  [[nodiscard]] Place Propose(Time now) const;
  [[nodiscard]] Place Ask(Time now);
  void Release();
  void Begin(const Place& place, Time now);

  const int index_;
  const std::uint64_t run_;
  NodeSurroundings* const others_;
  LeaseKeeper keeper_;
  Handovers handovers_;
  Arrivals arrivals_;
  protocol::Encoder encoder_;
  View view_;
  bool draining_ = false;
  bool closed_ = false;
  bool full_ = false;

  std::optional<bool> wanted_;  // requested of the keeper
  int next_heir_ = -1;          // likewise
  Time expected_until_{0};
  int heir_ = -1;
  Time heir_until_{0};
  std::optional<Time> asked_;  // a place was asked for, and nobody publishes yet
  bool waits_ = false;         // the publisher does, for its place

  bool is_here_ = false;
  std::uint64_t epoch_ = 0;
  Time served_until_{0};
  std::uint32_t newest_ = 0;
  std::optional<std::uint32_t> resumed_at_;
  std::uint32_t newest_received_ = 0;
  bool state_is_whole_ = true;
  bool state_is_newest_ = true;
};

}  // namespace furrow::server::testing
