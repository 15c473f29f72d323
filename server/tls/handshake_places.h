// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "server/core/time.h"
#include "server/shares/fair_share.h"

namespace furrow::server {

// Bounds the handshakes that are under way at the same time: each holds about 40 KiB before the
// client has shown who it is. A host gets another place only while it holds fewer than are free.
// Not thread-safe.
class HandshakePlaces {
 public:
  static constexpr std::size_t kPlaces = 64;
  // How often those ask again who have found no place. A handshake takes a few milliseconds.
  static constexpr auto kPoll = std::chrono::milliseconds(5);

  // A place, which is given back with the last copy. It may outlive this object.
  using Place = std::shared_ptr<void>;
  // Null: no place is free for the host.
  [[nodiscard]] Place Enter(const std::string& host) {
    if (!shares_->Enter(host)) return nullptr;
    return {shares_.get(), [shares = shares_, host](void*) { shares->Leave(host); }};
  }

 private:
  std::shared_ptr<FairShare> shares_ = std::make_shared<FairShare>(kPlaces);
};

}  // namespace furrow::server
