// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "server/core/time.h"
#include "server/machine/service_manager.h"
#include "server/saved/saved_state.h"

namespace furrow::server {

// What the daemon before this one has left with the service manager: sockets, and the state of its
// sessions. Closes what nobody takes.
class Inheritance {
 public:
  // `manager`: null if there is none, and then there is nothing.
  Inheritance(const ServiceManager::Kept& kept, ServiceManager* manager);
  ~Inheritance() { CloseRest(); }
  Inheritance(const Inheritance&) = delete;
  Inheritance& operator=(const Inheritance&) = delete;

  // False: the former daemon has left nothing, or there was none.
  [[nodiscard]] bool exists() const { return exists_; }
  // Reads the state, once. A state that this daemon cannot use is a line in the log.
  void ReadState(Time now);
  // Null: there is none, or somebody has taken it.
  [[nodiscard]] const SavedState* state() const { return state_ ? &*state_ : nullptr; }
  // Hands the state over. It holds keys, so whoever takes it lets it go soon.
  [[nodiscard]] std::optional<SavedState> TakeState() {
    return std::exchange(state_, std::nullopt);
  }

  // The listening sockets, if they listen at this address. Port 0: at any. Others are closed, so
  // that their ports are free.
  [[nodiscard]] std::optional<ServiceManager::Listener> TakeTcp(const std::string& bind,
                                                                std::uint16_t port) {
    return TakeListener(kept_.tcp, bind, port);
  }
  [[nodiscard]] std::optional<ServiceManager::Listener> TakeHttp(const std::string& bind,
                                                                 std::uint16_t port) {
    return TakeListener(kept_.http, bind, port);
  }
  // One UDP socket per shard, in the order of the state. Empty if they do not fit; they are closed
  // then, and the state loses its UDP peers.
  [[nodiscard]] std::vector<int> TakeUdp(const std::string& bind, std::uint16_t port, int shards);
  // The connection with this SocketCookie(); -1 if it is not there.
  [[nodiscard]] int TakeConnection(std::uint64_t socket);

  // Closes what was not taken.
  void CloseRest();

 private:
  [[nodiscard]] std::optional<ServiceManager::Listener> TakeListener(
      std::optional<ServiceManager::Listener>& kept, const std::string& bind, std::uint16_t port);
  void Discard(const std::vector<int>& descriptors);
  [[nodiscard]] bool SortUdp();

  const bool exists_;
  ServiceManager::Kept kept_;                           // without the connections
  std::unordered_map<std::uint64_t, int> connections_;  // by SocketCookie()
  ServiceManager* const manager_;
  std::optional<SavedState> state_;
};

}  // namespace furrow::server
