// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "server/cluster/coordinator.h"
#include "server/core/time.h"

namespace furrow::server {

// The places of subjects in a cluster, as the hub needs them. Without a cluster, every subject is
// served here, for ever. All functions require the hub's exclusive lock.
class Places {
 public:
  // `coordinator`: null without a cluster; outlives this object. `most`: subjects that are asked
  // for, but not published here yet.
  Places(Coordinator* coordinator, std::size_t most) : coordinator_(coordinator), most_(most) {}

  [[nodiscard]] bool in_cluster() const { return coordinator_ != nullptr; }
  // A stream offers the subject. Whoever gets kHere or kPending must offer again or publish within
  // kPatience, or another node may have the subject.
  [[nodiscard]] Place Ask(std::string_view subject, Time now);
  // The same for a subject that is published here already. It needs no room beside those that wait,
  // so a flood of offers ends no place.
  [[nodiscard]] Place Renew(std::string_view subject, Time now);
  // Where another node serves the subject; kNowhere if none does.
  [[nodiscard]] Place Elsewhere(std::string_view subject) const;
  // The node that should take the subject instead of this one, but none of `without`; kNowhere if
  // there is none.
  [[nodiscard]] Place Successor(std::string_view subject,
                                const std::set<std::string>& without = {}) const;
  // Why subjects never move from here to another node; empty: they do.
  [[nodiscard]] std::string WhyNothingMoves() const {
    return coordinator_ == nullptr ? "this daemon is in no cluster"
                                   : coordinator_->WhyNothingMoves();
  }
  // Other nodes as Welcome lists them.
  [[nodiscard]] std::vector<std::string> Others() const;
  void Release(std::string_view subject);
  // Gives back what was asked for and is not published. `is_published`: here.
  void Expire(const std::function<bool(std::string_view subject)>& is_published, Time now);
  // Another node is about to hand the subject over (Coordinator::Expect()). It is given back like
  // one that was asked for.
  [[nodiscard]] Place Expect(std::string_view subject, Time now);
  // The other node goes on with the subject.
  void HandOver(std::string_view subject, const NodeAddress& heir);
  // Takes no new subject from now on. Those that are here stay.
  void SetDraining();
  // Nothing is here from now on.
  void Close();
  [[nodiscard]] bool draining() const { return draining_; }
  static constexpr Time kPatience = std::chrono::seconds(3);
  // How often the hub asks again for the subjects that it has.
  static constexpr Time kRefresh = std::chrono::milliseconds(100);

 private:
  Coordinator* const coordinator_;
  const std::size_t most_;
  bool draining_ = false;
  bool closed_ = false;
  std::map<std::string, Time, std::less<>> asked_;  // when it was asked for last
};

// "'ada' is served by the node 'b' at 10.0.0.2", for people whose client does not follow.
[[nodiscard]] std::string ElsewhereText(std::string_view subject, const NodeAddress& node);

}  // namespace furrow::server
