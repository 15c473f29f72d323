// SPDX-License-Identifier: Apache-2.0
#include "server/http/request/request_budget.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace furrow::server {

void RequestBudget::Account::Update(double share, Time now) {
  if (now > updated) {
    const double gain = share * ToSeconds(now - updated);
    left = std::min(kBurstSeconds, left + gain);
    reserve = std::min(kBurstSeconds * kReserve, reserve + gain * kReserve);
    updated = now;
  }
}

void RequestBudget::Account::Pay(double seconds) {
  left = std::max(left - seconds, -kLongestDebt);
  reserve = std::max(reserve - seconds, -kLongestDebt * kReserve);
}

RequestBudget::Account& RequestBudget::Of(const std::string& host, Time now) {
  if (hosts_.size() > kMaxHosts) {
    // Those with a full budget need no memory.
    for (auto entry = hosts_.begin(); entry != hosts_.end();) {
      entry->second.Update(share_, now);
      entry = entry->second.left >= kBurstSeconds ? hosts_.erase(entry) : std::next(entry);
    }
    if (hosts_.size() > kMaxHosts) hosts_.clear();
  }
  Account& account = hosts_.try_emplace(host, Account{.updated = now}).first->second;
  account.Update(share_, now);
  return account;
}

int RequestBudget::Ask(const std::string& host, Time now) {
  if (share_ >= 1.0) return 0;
  Account& account = Of(host, now);
  all_.Update(share_ * kSharesOfAll, now);
  if (account.left <= 0.0 || (all_.left <= 0.0 && account.reserve <= 0.0)) {
    const double debt = std::max(-account.left, 0.0);
    return std::max(1, static_cast<int>(std::ceil(debt / share_)));
  }
  // At once, because many requests may be on their way before the first is charged.
  account.Pay(kLeastCost);
  all_.Pay(kLeastCost);
  return 0;
}

void RequestBudget::Charge(const std::string& host, Time cost, Time now) {
  const double rest = ToSeconds(cost) - kLeastCost;
  if (share_ >= 1.0 || rest <= 0.0) return;
  Of(host, now).Pay(rest);
  all_.Pay(rest);
}

}  // namespace furrow::server
