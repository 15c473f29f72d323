// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

namespace furrow::net {

// Returns the numeric address of a connected socket's peer, or an empty string if the socket is not
// connected.
[[nodiscard]] std::string PeerHost(int descriptor);

// Waits until `descriptor` has one of poll()'s `events` (POLLIN, POLLOUT). Returns false on
// timeout.
bool WaitFor(int descriptor, short events, std::chrono::milliseconds timeout);

}  // namespace furrow::net
