// SPDX-License-Identifier: Apache-2.0
#include "server/net/sender_gate.h"

#include <algorithm>
#include <iterator>

namespace furrow::server {
asio::ip::address Plain(const asio::ip::address& address) {
  if (!address.is_v6() || !address.to_v6().is_v4_mapped()) return address;
  return asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6());
}

SenderGate::SenderGate(std::span<const asio::ip::address> allowed, Policy policy)
    : exclusive_(policy == Policy::kOne || allowed.empty()) {
  std::ranges::transform(allowed, std::back_inserter(allowed_), Plain);
}

bool SenderGate::IsAllowed(const asio::ip::address& plain) const {
  return allowed_.empty() || std::ranges::find(allowed_, plain) != allowed_.end();
}

bool SenderGate::Admits(const asio::ip::address& sender, Time now) {
  const asio::ip::address plain = Plain(sender);
  if (!IsAllowed(plain)) return false;
  if (!exclusive_) return true;
  if (IsHeld(now)) return *holder_ == plain;
  const Candidate& candidate = Count(plain, now);
  // Of two with equal counts, the first in the list has come first.
  const auto leader = std::ranges::max_element(candidates_, {}, &Candidate::datagrams);
  return leader->address == candidate.address;
}

// Counts a datagram while nobody holds the port.
SenderGate::Candidate& SenderGate::Count(const asio::ip::address& sender, Time now) {
  std::erase_if(candidates_, [now](const Candidate& each) { return now - each.last > kRelease; });
  auto found = std::ranges::find(candidates_, sender, &Candidate::address);
  if (found == candidates_.end()) {
    // Of those that have sent least, the first one makes room. So a steady sender lasts until its
    // next datagram, unless as many forged addresses as there are candidates come in between.
    if (candidates_.size() == kMaxCandidates) {
      candidates_.erase(std::ranges::min_element(candidates_, {}, &Candidate::datagrams));
    }
    candidates_.push_back({sender});
    found = std::prev(candidates_.end());
  }
  ++found->datagrams;
  found->last = now;
  return *found;
}

bool SenderGate::IsSuccessor(const asio::ip::address& sender) const {
  return exclusive_ && read_ && *read_ != Plain(sender);
}

bool SenderGate::Hold(const asio::ip::address& sender, Time now) {
  if (!exclusive_) return false;
  const asio::ip::address plain = Plain(sender);
  read_ = plain;
  if (IsHeld(now)) {
    heard_ = now;  // Admits() has let nobody else through
    return false;
  }
  const auto candidate = std::ranges::find(candidates_, plain, &Candidate::address);
  if (candidate == candidates_.end() || candidate->datagrams < kSteady) return false;
  const bool is_new = holder_ != plain;
  holder_ = plain;
  heard_ = now;
  candidates_.clear();
  return is_new;
}

std::optional<asio::ip::address> SenderGate::HolderAt(Time now) const {
  return exclusive_ && IsHeld(now) ? holder_ : std::nullopt;
}

bool SenderGate::Give(const asio::ip::address& sender, Time now) {
  const asio::ip::address plain = Plain(sender);
  if (!IsAllowed(plain)) return false;
  if (!exclusive_) return true;
  holder_ = plain;
  heard_ = now;
  candidates_.clear();
  return true;
}

void SenderGate::Discard(const asio::ip::address& sender) {
  const asio::ip::address plain = Plain(sender);
  std::erase_if(candidates_, [&](const Candidate& each) { return each.address == plain; });
}

}  // namespace furrow::server
