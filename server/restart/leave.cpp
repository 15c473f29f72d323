// SPDX-License-Identifier: Apache-2.0
#include "server/restart/leave.h"

#include <array>
#include <chrono>
#include <cstdint>
#include <new>
#include <string_view>

#include <unistd.h>

#include "protocol/secure/crypto/secret.h"
#include "server/saved/saved_state_codec.h"
#include "server/saved/state_file.h"

namespace furrow::server {
namespace {

constexpr auto kKeepPatience = std::chrono::seconds(1);

Result<int> MakeFile(const SavedState& state) {
  std::vector<std::uint8_t> bytes = EncodeSavedState(state);
  Result<int> file = bytes.size() <= kMaxStateBytes
                         ? MakeStateFile(bytes)
                         : Status(StatusCode::kLimit, "the sessions are too large to be saved");
  protocol::secure::Wipe(bytes);
  return file;
}

// False: not all could be sent, or the manager has not read it.
bool KeepAll(int state, const LeftSockets& sockets, ServiceManager* manager) {
  const auto keep_one = [manager](std::string_view name, const std::optional<int>& socket) {
    return !socket || manager->Keep(name, std::array{*socket});
  };
  try {
    return manager->Keep(ServiceManager::kKeptState, std::array{state}) &&
           keep_one(ServiceManager::kKeptTcp, sockets.tcp) &&
           keep_one(ServiceManager::kKeptHttp, sockets.http) &&
           manager->Keep(ServiceManager::kKeptUdp, sockets.udp) &&
           manager->Keep(ServiceManager::kKeptConnection, sockets.connections) &&
           manager->Await(kKeepPatience);
  } catch (const std::bad_alloc&) {
    return false;
  }
}

}  // namespace

Status Leave(const SavedState& state, const LeftSockets& sockets, ServiceManager* manager) {
  auto file = MakeFile(state);
  FURROW_RETURN_IF_ERROR(file);
  if (KeepAll(*file, sockets, manager)) {
    close(*file);
    return {};
  }
  // The manager may have some of it, and may not read this either. Without the state, the next
  // daemon can go on with none of the sessions.
  manager->ForgetAll();
  DestroyStateFile(*file);
  return {StatusCode::kIo, "the service manager does not keep the sessions"};
}

}  // namespace furrow::server
