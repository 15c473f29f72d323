// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "base/status.h"
#include "server/cluster/place.h"
#include "server/core/time.h"

namespace furrow::server {

// The subjects of a node, which other nodes shall get. Hub says what the functions do.
class DepartingSubjects {
 public:
  virtual ~DepartingSubjects() = default;
  virtual void TakeNothingNew() = 0;
  [[nodiscard]] virtual std::vector<std::string> SubjectNames() = 0;
  [[nodiscard]] virtual Place SuccessorOf(const std::string& subject, Time now,
                                          const std::set<std::string>& without) = 0;
  [[nodiscard]] virtual bool WriteState(const std::string& subject, std::uint32_t number,
                                        std::vector<std::uint8_t>& message) = 0;
  [[nodiscard]] virtual Status HandOver(const std::string& subject, const NodeAddress& node,
                                        std::uint32_t number, std::vector<std::uint8_t>& message,
                                        Time now) = 0;
};

// Conversations with other nodes, at most one with each. Messages may be lost, come twice or in
// another order.
class NodeLinks {
 public:
  virtual ~NodeLinks() = default;
  // Begins to connect, for at most `patience`. The result comes through Handovers::OnLink().
  virtual void Open(const NodeAddress& node, Time patience) = 0;
  virtual void Send(const std::string& node, std::span<const std::uint8_t> message) = 0;
  // True after an error of the node, which may answer nothing more.
  [[nodiscard]] virtual bool HasFailed(const std::string& node) const = 0;
  virtual void Close(const std::string& node) = 0;
};

// Gives the subjects of this node to other nodes, one after the other:
//
// 1. The other node gets the state of the subject and says whether it takes it. The subject goes on
//    here meanwhile.
// 2. The last state leaves, the lease goes to the other node, and so do the publisher and the
//    subscribers, at the same moment.
//
// A node that refuses, does not answer or cannot be reached is passed over for the next one. A
// state machine without I/O and clocks. Not thread-safe.
class Handovers {
 public:
  // An unanswered message is sent again after this time, until the patience is over.
  static constexpr Time kRepeat = std::chrono::milliseconds(20);
  static constexpr Time kAnswerPatience = std::chrono::milliseconds(1000);
  static constexpr Time kConnectPatience = std::chrono::milliseconds(1500);
  // The pause before subjects are tried again that could not be moved.
  static constexpr Time kNextRound = std::chrono::milliseconds(200);

  // Not null; outlive this object.
  Handovers(DepartingSubjects* subjects, NodeLinks* links) : subjects_(subjects), links_(links) {}

  // Takes nothing new and moves all subjects. Ends when no subject is left; after EndBy(), also
  // when no other one can be moved, or at that time.
  void Begin();
  void EndBy(Time end) { end_ = end; }
  [[nodiscard]] bool running() const { return step_ != Step::kIdle; }
  // Does what must be done by now. Call it after each event and every few milliseconds.
  void Tick(Time now);

  // The end of NodeLinks::Open().
  void OnLink(const std::string& node, const Status& status);
  // An answer of the node to the message with this number; `why`: the reason if it refuses.
  void OnAnswer(const std::string& node, std::uint32_t number, bool accepted,
                const std::string& why);

  // For people.
  struct Progress {
    std::uint32_t moved = 0;
    std::string stays;  // the subject that could not be moved last; empty: none
    std::string why;
  };
  [[nodiscard]] const Progress& progress() const { return progress_; }

 private:
  enum class Step : std::uint8_t {
    kIdle,
    kNextSubject,  // looks for one that was not tried in this round
    kChoose,       // looks for a node that may take it
    kConnect,      // waits for the conversation
    kAsk,          // waits for the answer
    kPause,        // until the next round
    kLastAnswers,  // the last states are on their way
  };
  // A message that its node has not answered yet.
  struct Sent {
    std::string node;
    std::vector<std::uint8_t> message;
    Time sent{0};
    Time give_up{0};
  };
  struct Answer {
    bool accepted = false;
    std::string why;
  };

  [[nodiscard]] bool Advance(Time now);
  void BeginRound();
  bool NextSubject(Time now);
  void EndRound(Time now);
  bool Choose(Time now);
  bool Connect(Time now);
  void AskNode(Time now);
  bool Ask(Time now);
  void OnAccepted(Time now);
  void PassOver(Status failure);
  void EndSubject(const Status& status);
  void Send(const std::string& node, std::uint32_t number, std::vector<std::uint8_t> message,
            Time now);
  void Repeat(Time now);
  void Unlink(const std::string& node);
  [[nodiscard]] Time Patience(Time most, Time now) const;
  [[nodiscard]] bool IsOver(Time now) const { return end_ && now >= *end_; }

  DepartingSubjects* const subjects_;
  NodeLinks* const links_;
  Step step_ = Step::kIdle;
  std::optional<Time> end_;
  Time next_round_{0};
  std::uint32_t next_number_ = 1;

  // Of this round.
  std::vector<std::string> round_;  // the subjects that are left, the next one last
  std::set<std::string> silent_;    // nodes that failed
  bool any_has_left_ = false;

  // Of the subject that is being moved.
  std::string subject_;
  std::set<std::string> without_;  // nodes that did not take it, and the silent ones
  Status failure_;                 // of the last of them
  NodeAddress node_;
  std::uint32_t number_ = 0;  // of the question
  std::optional<Answer> answer_;

  std::map<std::string, std::optional<Status>> open_;  // by node; nothing: it is connecting
  std::map<std::uint32_t, Sent> sent_;                 // by number
  Progress progress_;
};

}  // namespace furrow::server
