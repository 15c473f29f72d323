// SPDX-License-Identifier: Apache-2.0
#include "server/net/sender_gate.h"

#include <algorithm>
#include <iterator>

namespace furrow::server {
namespace {

// One form per address: a dual-stack socket shows IPv4 addresses as ::ffff:a.b.c.d.
asio::ip::address Plain(const asio::ip::address& address) {
  if (!address.is_v6() || !address.to_v6().is_v4_mapped()) return address;
  return asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6());
}

}  // namespace

SenderGate::SenderGate(std::span<const asio::ip::address> allowed, Policy policy)
    : exclusive_(policy == Policy::kOne || allowed.empty()) {
  std::ranges::transform(allowed, std::back_inserter(allowed_), Plain);
}

bool SenderGate::Admits(const asio::ip::address& sender, Time now) const {
  const asio::ip::address plain = Plain(sender);
  if (!allowed_.empty() && std::ranges::find(allowed_, plain) == allowed_.end()) return false;
  // A holder that has been silent for kRelease has lost its claim, although holder_ still names it.
  return !exclusive_ || !holder_ || *holder_ == plain || now - heard_ > kRelease;
}

bool SenderGate::IsSuccessor(const asio::ip::address& sender) const {
  return exclusive_ && holder_ && *holder_ != Plain(sender);
}

bool SenderGate::Hold(const asio::ip::address& sender, Time now) {
  if (!exclusive_) return false;
  const asio::ip::address plain = Plain(sender);
  const bool is_new = holder_ != plain;
  holder_ = plain;
  heard_ = now;
  return is_new;
}

}  // namespace furrow::server
