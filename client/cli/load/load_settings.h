// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "client/cli/load/load_flags.h"

namespace furrow::cli {

// All settings that the figures of a load test depend on, so that its JSON report is complete and
// the test can be repeated. `flags` must contain the values of the run, with defaults filled in.
// Settings that the recording or the default character decides are null.
[[nodiscard]] nlohmann::json SettingsOf(const LoadFlags& flags);

}  // namespace furrow::cli
