// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/config/config.h"
#include "server/machine/confine.h"

namespace furrow::server {

// The files that a daemon needs: those of the configuration, its data, the system's libraries and
// drivers, recordings, and the drivers' caches; and, as long as it loads, its helper programs.
[[nodiscard]] Confinement FilesOf(const Config& config);

}  // namespace furrow::server
