// SPDX-License-Identifier: Apache-2.0
#include "server/core/waiting_bytes.h"

namespace furrow::server {

void WaitingBytes::SetMost(std::size_t most) {
  const std::lock_guard lock(mutex_);
  shares_.SetPlaces(most / kChunk);
}

std::size_t WaitingBytes::taken() const {
  const std::lock_guard lock(mutex_);
  return shares_.taken() * kChunk;
}

bool WaitingBytes::Change(const std::string& host, std::size_t* held, std::size_t wanted) {
  const std::lock_guard lock(mutex_);
  const std::size_t before = *held;
  while (*held < wanted && shares_.Enter(host)) ++*held;
  if (*held < wanted) {
    for (; *held > before; --*held) shares_.Leave(host);
    metrics_->Add(Counter::kWaitingRefused);
    return false;
  }
  for (; *held > wanted; --*held) shares_.Leave(host);
  return true;
}

}  // namespace furrow::server
