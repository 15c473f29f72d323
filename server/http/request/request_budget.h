// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <unordered_map>

#include "server/core/time.h"

namespace furrow::server {

// The time of the hub's thread that API requests may use, because nothing else runs there
// meanwhile: a share per host and one of all hosts together. A request costs what it took, so cheap
// requests may come often and expensive ones rarely. When all hosts together have used up theirs,
// each host still has a tenth of its share, so that nobody is shut out. Not thread-safe.
class RequestBudget {
 public:
  static constexpr double kBurstSeconds = 0.5;    // what may be used at once
  static constexpr double kLongestDebt = 0.5;     // seconds; a long request costs no more
  static constexpr double kLeastCost = 50e-6;     // seconds, of any request
  static constexpr double kSharesOfAll = 2.0;     // all hosts together, in shares
  static constexpr double kReserve = 0.1;         // of a host's share and burst
  static constexpr std::size_t kMaxHosts = 4096;  // with a budget that is not full

  // `share`: of one host, in seconds per second; 1 or more: no limit.
  explicit RequestBudget(double share) : share_(share) {}

  // A request of this host. 0: it may be answered; Charge() follows. Else the host must wait for
  // this many seconds.
  [[nodiscard]] int Ask(const std::string& host, Time now);
  // The request took `cost`.
  void Charge(const std::string& host, Time cost, Time now);

 private:
  struct Account {
    double left = kBurstSeconds;  // < 0: debt
    double reserve = kBurstSeconds * kReserve;
    Time updated{0};

    void Update(double share, Time now);
    void Pay(double seconds);
  };
  Account& Of(const std::string& host, Time now);

  const double share_;
  Account all_;
  std::unordered_map<std::string, Account> hosts_;
};

}  // namespace furrow::server
