// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <unordered_map>

#include "server/core/time.h"

namespace furrow::server {

// Limits how much work per second is done for each host, and for all hosts together. Work is paid
// for afterwards: a host without debts gets a job of any size, and the next one when that is paid
// for. A host that asks for nothing saves up at most one second of work.
//
// Jobs are delayed, never dropped. Not thread-safe.
class WorkBudget {
 public:
  // In units of work per second; 0: without a limit.
  struct Limits {
    double host = 0.0;
    double total = 0.0;
    bool operator==(const Limits&) const = default;
  };
  WorkBudget() = default;
  explicit WorkBudget(const Limits& limits) : limits_(limits) {}

  // The moment from which on the host may be served; not later than `now` if it may be served now.
  [[nodiscard]] Time ReadyAt(std::uint64_t host) const {
    const auto found = paid_at_.find(host);
    return found == paid_at_.end() ? total_paid_at_ : std::max(total_paid_at_, found->second);
  }
  // The host is served now. `work` > 0.
  void Charge(std::uint64_t host, double work, Time now) {
    if (limits_.total > 0.0) total_paid_at_ = After(total_paid_at_, work / limits_.total, now);
    if (limits_.host <= 0.0) return;
    const auto known = paid_at_.try_emplace(host, now - kSavings).first;
    known->second = After(known->second, work / limits_.host, now);
    if (paid_at_.size() <= kMaxHosts) return;
    // Those whose savings are full need no memory.
    std::erase_if(paid_at_, [now](const auto& each) { return each.second <= now - kSavings; });
    if (paid_at_.size() <= kMaxHosts) return;
    paid_at_.erase(std::ranges::min_element(paid_at_, {}, [host](const auto& each) {
      return each.first == host ? Time::max() : each.second;
    }));
  }
  [[nodiscard]] std::size_t num_hosts() const { return paid_at_.size(); }

  static constexpr Time kSavings = std::chrono::seconds(1);
  static constexpr std::size_t kMaxHosts = 1024;

 private:
  // A host in debt is charged for pictures that another host has asked for, too. Its debt stays
  // within one second, or within the cost of that picture.
  static Time After(Time paid_at, double seconds, Time now) {
    const Time cost = FromSeconds(std::min(seconds, kMaxDebtSeconds));
    return std::min(std::max(paid_at, now - kSavings) + cost, now + std::max(cost, kSavings));
  }
  static constexpr double kMaxDebtSeconds = 3600.0;

  Limits limits_;
  Time total_paid_at_ = Time::min() / 2;
  std::unordered_map<std::uint64_t, Time> paid_at_;  // when each host's work is paid for
};

}  // namespace furrow::server
