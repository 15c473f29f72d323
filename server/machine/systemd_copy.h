// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace furrow::server {

// True for a file that systemd copies for one service when it starts it (LoadCredential=,
// systemd.exec(5)): it lies in the service's folder below /run/credentials, or below
// /run/user/UID/credentials for a user's own service. So it exists only while the service runs,
// and the original may have changed since.
[[nodiscard]] bool IsSystemdCopy(const std::filesystem::path& path);

}  // namespace furrow::server
