// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "client/cli/load/load_flags.h"

namespace furrow::cli {

// Returns all settings on which the figures of a load test depend, as JSON, so that the test can be
// repeated. `flags` must contain the values of the run, with defaults filled in. A setting is null
// if the recording or the default character decides it.
[[nodiscard]] nlohmann::json SettingsOf(const LoadFlags& flags);

}  // namespace furrow::cli
