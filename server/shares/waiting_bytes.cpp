// SPDX-License-Identifier: Apache-2.0
#include "server/shares/waiting_bytes.h"

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
  if (wanted > *held) {
    if (!shares_.Enter(host, wanted - *held)) return false;
  } else {
    shares_.Leave(host, *held - wanted);
  }
  *held = wanted;
  return true;
}

}  // namespace furrow::server
