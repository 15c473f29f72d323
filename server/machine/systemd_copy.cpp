// SPDX-License-Identifier: Apache-2.0
#include "server/machine/systemd_copy.h"

namespace furrow::server {

bool IsSystemdCopy(const std::filesystem::path& path) {
  const std::filesystem::path of_service = path.parent_path();
  if (of_service.filename().empty()) return false;
  const std::filesystem::path folder = of_service.parent_path();
  if (folder == "/run/credentials") return true;
  return folder.filename() == "credentials" && folder.parent_path().parent_path() == "/run/user";
}

}  // namespace furrow::server
