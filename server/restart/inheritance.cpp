// SPDX-License-Identifier: Apache-2.0
#include "server/restart/inheritance.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <asio/ip/address.hpp>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "protocol/secure/crypto/secret.h"
#include "server/machine/socket_cookie.h"
#include "server/net/local_endpoint.h"
#include "server/saved/saved_state_codec.h"
#include "server/saved/state_file.h"

namespace furrow::server {
namespace {

// A manager answers within milliseconds. One that does not may not know what it is asked.
constexpr auto kPatience = std::chrono::seconds(1);

bool IsEmpty(const ServiceManager::Kept& kept) {
  return kept.state < 0 && !kept.tcp && !kept.http && kept.udp.empty() && kept.connections.empty();
}

// True if the socket is bound to the address. Port 0: to any port of it.
bool IsBoundTo(int socket, const std::string& bind, std::uint16_t port) {
  asio::error_code error;
  const asio::ip::address wanted = asio::ip::make_address(bind, error);
  if (error) return false;
  const auto bound = LocalEndpoint(socket, error);
  return !error && bound.address() == wanted && (port == 0 || bound.port() == port);
}

}  // namespace

Inheritance::Inheritance(const ServiceManager::Kept& kept, ServiceManager* manager)
    : exists_(!IsEmpty(kept)), kept_(kept), manager_(manager) {
  for (const int connection : std::exchange(kept_.connections, {})) {
    if (!connections_.try_emplace(SocketCookie(connection), connection).second) close(connection);
  }
  // A daemon that crashes must not leave them to the next one.
  if (manager_ != nullptr && exists_) manager_->ForgetAll();
}

void Inheritance::ReadState(Time now) {
  if (kept_.state < 0) return;
  auto bytes = TakeStateFile(std::exchange(kept_.state, -1));
  Status status = bytes.status();
  if (status.ok()) {
    auto state = DecodeSavedState(*bytes, now);
    protocol::secure::Wipe(*bytes);
    status = state.status();
    if (state.ok()) state_ = *std::move(state);
  }
  if (!status.ok()) spdlog::warn("clients must connect again: {}", status.ToString());
}

std::optional<ServiceManager::Listener> Inheritance::TakeListener(
    std::optional<ServiceManager::Listener>& kept, const std::string& bind, std::uint16_t port) {
  auto taken = std::exchange(kept, std::nullopt);
  if (!taken || IsBoundTo(taken->socket, bind, port)) return taken;
  Discard({taken->socket});
  return std::nullopt;
}

// An address is free when the manager has closed its copy, too.
void Inheritance::Discard(const std::vector<int>& descriptors) {
  if (descriptors.empty()) return;
  for (const int descriptor : descriptors) close(descriptor);
  if (manager_ != nullptr) (void)manager_->Await(kPatience);
}

// In the order of the state, whose peers belong to shards.
bool Inheritance::SortUdp() {
  std::vector<int> sorted;
  for (const std::uint64_t cookie : state_->udp_sockets) {
    const auto found = std::ranges::find(kept_.udp, cookie, &SocketCookie);
    if (found == kept_.udp.end()) return false;
    sorted.push_back(*found);
  }
  if (sorted.size() != kept_.udp.size()) return false;
  kept_.udp = std::move(sorted);
  return true;
}

std::vector<int> Inheritance::TakeUdp(const std::string& bind, std::uint16_t port, int shards) {
  const bool fit =
      kept_.udp.size() == static_cast<std::size_t>(shards) &&
      std::ranges::all_of(kept_.udp, [&](int each) { return IsBoundTo(each, bind, port); }) &&
      (!state_ || SortUdp());
  if (fit) return std::exchange(kept_.udp, {});
  Discard(std::exchange(kept_.udp, {}));
  if (state_) {
    state_->udp.clear();
    state_->secure.clear();
  }
  return {};
}

int Inheritance::TakeConnection(std::uint64_t socket) {
  const auto found = connections_.extract(socket);
  return found.empty() ? -1 : found.mapped();
}

void Inheritance::CloseRest() {
  std::vector<int> rest = std::exchange(kept_.udp, {});
  for (const auto& [cookie, connection] : std::exchange(connections_, {})) {
    rest.push_back(connection);
  }
  for (auto* const listener : {&kept_.tcp, &kept_.http}) {
    if (*listener) rest.push_back((*listener)->socket);
    listener->reset();
  }
  if (kept_.state >= 0) rest.push_back(std::exchange(kept_.state, -1));
  for (const int descriptor : rest) close(descriptor);
}

}  // namespace furrow::server
