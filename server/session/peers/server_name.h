// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace furrow::server {

// How the daemon names itself in Welcome: program and version.
inline constexpr char kServerName[] = "furrowd " FURROW_VERSION;

}  // namespace furrow::server
