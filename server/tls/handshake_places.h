// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <set>
#include <string>
#include <utility>

namespace furrow::server {

// Bounds the TLS connections of strangers: clients whose handshake goes on, or that must still show
// who they are. Each makes OpenSSL hold 44 KiB or less, so each host has one place, for all ports
// together, and the others of the host wait as bare sockets (BareSockets). Thread-safe.
class HandshakePlaces {
 public:
  // Of all hosts. A place takes at most 64 KiB with all that belongs to it, so all take 16 MiB.
  static constexpr std::size_t kPlaces = 256;

 private:
  struct Shared {
    std::mutex mutex;
    std::set<std::string> held;          // hosts with a place
    std::map<std::string, int> waiting;  // hosts without one, by host; none is 0
  };

 public:
  // A place of a host, until it is destroyed. It may outlive the HandshakePlaces.
  class Place {
   public:
    Place(std::shared_ptr<Shared> shared, std::string host)
        : shared_(std::move(shared)), host_(std::move(host)) {}
    ~Place() {
      const std::lock_guard lock(shared_->mutex);
      shared_->held.erase(host_);
    }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

    // Somebody waits until the place is free: a client of the host, or any one if all places are
    // taken.
    [[nodiscard]] bool IsWanted() const {
      const std::lock_guard lock(shared_->mutex);
      if (shared_->waiting.empty()) return false;
      return shared_->held.size() >= kPlaces || shared_->waiting.contains(host_);
    }

   private:
    const std::shared_ptr<Shared> shared_;
    const std::string host_;
  };

  // Null: the host has a place, or none is left.
  [[nodiscard]] std::unique_ptr<Place> Enter(const std::string& host) const {
    const std::lock_guard lock(shared_->mutex);
    if (shared_->held.size() >= kPlaces || shared_->held.contains(host)) return nullptr;
    const auto held = shared_->held.insert(host).first;
    try {
      return std::make_unique<Place>(shared_, host);
    } catch (const std::bad_alloc&) {
      shared_->held.erase(held);
      throw;
    }
  }

  // A client of the host waits for a place as long as the result lives.
  using Waiting = std::shared_ptr<void>;
  [[nodiscard]] Waiting Wait(std::string host) const {
    {
      const std::lock_guard lock(shared_->mutex);
      ++shared_->waiting[host];
    }
    return {shared_.get(),
            [shared = shared_, host = std::move(host)](void*) { StopWaiting(*shared, host); }};
  }

 private:
  static void StopWaiting(Shared& shared, const std::string& host) {
    const std::lock_guard lock(shared.mutex);
    const auto count = shared.waiting.find(host);
    if (--count->second == 0) shared.waiting.erase(count);
  }

  const std::shared_ptr<Shared> shared_ = std::make_shared<Shared>();
};

}  // namespace furrow::server
