// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "base/status.h"
#include "server/machine/service_manager.h"
#include "server/saved/saved_state.h"

namespace furrow::server {

// The sockets that go on in the next daemon.
struct LeftSockets {
  std::optional<int> tcp;   // absent: the service manager has it anyway
  std::optional<int> http;  // the same, or there is none
  std::vector<int> udp;
  std::vector<int> connections;
};

// Leaves the state and the sockets with the service manager, and waits until it has read them.
// Nothing may be sent in the sessions of the state afterwards. Errors: kIo, the manager does not
// answer, or there is no file in memory; kLimit, the state is too large. The next daemon gets no
// state then.
[[nodiscard]] Status Leave(const SavedState& state, const LeftSockets& sockets,
                           ServiceManager* manager);

}  // namespace furrow::server
