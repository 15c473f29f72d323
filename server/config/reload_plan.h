// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "server/config/config.h"

namespace furrow::server {

// What changes when a running daemon reads its configuration again.
struct ReloadPlan {
  Config config;                           // the running one, with the changes that take effect now
  std::vector<std::string> applied;        // their keys, as in TOML
  std::vector<std::string> needs_restart;  // the keys of the other changes
};

// Compares the running configuration with a new one. `draws`: a renderer is running, which has the
// rig's pictures. TLS cannot be switched on or off, nor the demand for certificates of clients,
// because connections that exist have begun with or without.
[[nodiscard]] ReloadPlan PlanReload(const Config& running, const Config& wanted, bool draws);

}  // namespace furrow::server
