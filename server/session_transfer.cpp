// SPDX-License-Identifier: Apache-2.0
#include "server/session_transfer.h"

#include <cstddef>
#include <string>

#include <spdlog/spdlog.h>

#include "base/text.h"
#include "server/core/within_memory.h"
#include "server/net/clock.h"
#include "server/restart/leave.h"
#include "server/saved/saved_state.h"

namespace furrow::server {
namespace {

// "3 peers and 2 subjects".
std::string SavedText(const SavedState& state) {
  const std::size_t peers = state.udp.size() + state.connections.size();
  return Counted(peers, "peer") + " and " + Counted(state.subjects.size(), "subject");
}

Status TryToLeave(const TransferParts& parts, std::optional<int> http) {
  // The state, and all sockets but connections, of which those that fit follow.
  const std::size_t fewest = 1 + parts.ports->num_sockets() + (http ? 1 : 0);
  const std::size_t store = ServiceManager::StoreSize();
  if (store < fewest) return {StatusCode::kLimit, "the service manager keeps too few descriptors"};
  SavedState state;
  state.session = parts.session;
  LeftSockets sockets = parts.ports->Save(&state, store - fewest, ReadClock());
  state.saved = ReadClock();
  sockets.http = http;
  FURROW_RETURN_IF_ERROR(Leave(state, sockets, parts.manager));
  spdlog::info("handed {} over to the next daemon", SavedText(state));
  return {};
}

}  // namespace

bool LeaveSessions(const TransferParts& parts, std::optional<int> http) {
  const Status status =
      OrOutOfMemory(parts.metrics, "saving the sessions", [&] { return TryToLeave(parts, http); });
  if (status.ok()) return true;
  spdlog::warn("clients must connect again: {}", status.ToString());
  parts.ports->Stay();
  return false;
}

void ResumeSessions(const TransferParts& parts, Inheritance* former) {
  // It holds keys, so it ends here.
  if (const std::optional<SavedState> state = former->TakeState()) {
    const Time now = ReadClock();
    const Hub::ResumedPeers peers = parts.ports->Resume(*state, former, now);
    parts.hub->Resume(state->subjects, peers, now - state->saved, now);
    spdlog::info("resumed {} of the former daemon after {:.0f} ms", SavedText(*state),
                 ToSeconds(now - state->saved) * 1e3);
  }
  former->CloseRest();
}

}  // namespace furrow::server
