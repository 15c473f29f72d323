// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "base/status.h"
#include "server/cluster/coordinator.h"
#include "server/config/config.h"

namespace furrow::server {

// The coordinator that the configuration asks for; null: the daemon is alone. Starts nothing and
// reads the file of the credentials. Errors: those of MakeNatsStore(), and of the file.
[[nodiscard]] Result<std::unique_ptr<Coordinator>> MakeCoordinator(const Config& config,
                                                                   std::uint64_t run);

}  // namespace furrow::server
