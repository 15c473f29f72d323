// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "client/cli/load/load_flags.h"

namespace furrow::cli {

// All that a load test's figures depend on, so that its report stands alone and can be repeated.
// `flags`: as they are run, defaults filled in. What was left to the recording or the default
// character is null.
[[nodiscard]] nlohmann::json SettingsOf(const LoadFlags& flags);

}  // namespace furrow::cli
