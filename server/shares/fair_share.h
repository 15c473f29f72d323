// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <unordered_map>

namespace furrow::server {

// Shares a number of places between hosts, so that no host can take them all: a host gets another
// place only while it holds fewer than are free. So one host gets half of the places, the next one
// half of the rest, and so on. Of 256 places there are some for a newcomer until the ninth host
// that takes all it can get.
//
// The rule is the dynamic threshold of Choudhury and Hahne, "Dynamic queue length thresholds for
// shared-memory packet switches" (1998), with alpha 1. Not thread-safe.
class FairShare {
 public:
  explicit FairShare(std::size_t places) : places_(places) {}

  // False: the host has its share, or there is no place left. `count`: of places that it wants, at
  // least 1, as if it took one after the other.
  [[nodiscard]] bool HasRoomFor(const std::string& host, std::size_t count = 1) const {
    return held(host) + taken_ + 2 * (count - 1) < places_;
  }
  // Takes places, all or none. False: there is no room.
  [[nodiscard]] bool Enter(const std::string& host, std::size_t count = 1) {
    if (!HasRoomFor(host, count)) return false;
    held_[host] += count;
    taken_ += count;
    return true;
  }
  // Gives back places that Enter() took for the host.
  void Leave(const std::string& host, std::size_t count = 1) {
    const auto held = held_.find(host);
    held->second -= count;
    if (held->second == 0) held_.erase(held);
    taken_ -= count;
  }

  // Changes the number of places. Those that are taken stay taken, even if they are more.
  void SetPlaces(std::size_t places) { places_ = places; }

  // The places that a host holds.
  [[nodiscard]] std::size_t held(const std::string& host) const {
    const auto held = held_.find(host);
    return held == held_.end() ? 0 : held->second;
  }
  [[nodiscard]] std::size_t taken() const { return taken_; }

 private:
  std::size_t places_;
  std::size_t taken_ = 0;
  std::unordered_map<std::string, std::size_t> held_;  // by host; none is 0
};

}  // namespace furrow::server
