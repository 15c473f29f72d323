// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <vector>

#include "base/status.h"
#include "server/saved/saved_state.h"

namespace furrow::server {

// Raise it with every change of what SavedState holds or of what that means. A daemon reads its own
// version alone: an upgrade may change both, and clients that connect again lose a moment only.
inline constexpr std::uint32_t kSavedStateVersion = 1;

// An older state is useless: clients have connected again or given up.
inline constexpr Time kSavedStateAge = std::chrono::seconds(10);

// The bytes hold keys: wipe them after use (protocol::secure::Wipe).
[[nodiscard]] std::vector<std::uint8_t> EncodeSavedState(const SavedState& state);

// Reads a state and checks it as if a stranger had written it. `now`: of the clock that
// SavedState::saved counts on. Errors: kUnsupported, it is of another version of the state or of
// the wire; kParse, it is damaged; kUnavailable, it is too old.
[[nodiscard]] Result<SavedState> DecodeSavedState(std::span<const std::uint8_t> bytes, Time now);

}  // namespace furrow::server
