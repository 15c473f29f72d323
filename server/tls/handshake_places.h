// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <string>
#include <utility>

namespace furrow::server {

// Bounds the TLS connections of strangers: clients whose handshake goes on, or that must still show
// who they are. Each makes OpenSSL hold 44 KiB or less, so each host has one place or a few, for
// all ports together, and the others of the host wait as bare sockets (BareSockets). Thread-safe.
class HandshakePlaces {
 public:
  // Of all hosts. A place takes at most 64 KiB with all that belongs to it, so all take 16 MiB.
  static constexpr std::size_t kPlaces = 256;

 private:
  struct Shared {
    std::mutex mutex;
    std::size_t places_of_host = 1;
    std::size_t places = 0;                   // that are held
    std::map<std::string, std::size_t> held;  // by host; none is 0
    std::map<std::string, int> waiting;       // for a place, by host; none is 0

    [[nodiscard]] bool HasRoomFor(const std::string& host) const {
      const auto known = held.find(host);
      return known == held.end() || known->second < places_of_host;
    }
    [[nodiscard]] bool is_full() const { return places >= kPlaces; }
  };

 public:
  // A place of a host, until it is destroyed. It may outlive the HandshakePlaces.
  class Place {
   public:
    Place(std::shared_ptr<Shared> shared, std::string host)
        : shared_(std::move(shared)), host_(std::move(host)) {}
    ~Place() {
      const std::lock_guard lock(shared_->mutex);
      --shared_->places;
      const auto count = shared_->held.find(host_);
      if (--count->second == 0) shared_->held.erase(count);
    }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

    // A client waits until the place is free: one of the host, or, if all places are taken, one of
    // another host that may have a place more.
    [[nodiscard]] bool IsWanted() const {
      const std::lock_guard lock(shared_->mutex);
      if (shared_->waiting.contains(host_)) return true;
      return shared_->is_full() && std::ranges::any_of(shared_->waiting, [this](const auto& each) {
               return shared_->HasRoomFor(each.first);
             });
    }

   private:
    const std::shared_ptr<Shared> shared_;
    const std::string host_;
  };

  // Changes the number of places of each host. Those that are held stay held.
  void SetPlacesOfHost(std::size_t places) {
    const std::lock_guard lock(shared_->mutex);
    shared_->places_of_host = places;
  }

  // Null: the host has its places, or none is left.
  [[nodiscard]] std::unique_ptr<Place> Enter(const std::string& host) const {
    const std::lock_guard lock(shared_->mutex);
    if (shared_->is_full() || !shared_->HasRoomFor(host)) return nullptr;
    const auto count = shared_->held.try_emplace(host, 0).first;
    try {
      auto place = std::make_unique<Place>(shared_, host);
      ++count->second;
      ++shared_->places;
      return place;
    } catch (const std::bad_alloc&) {
      if (count->second == 0) shared_->held.erase(count);
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
