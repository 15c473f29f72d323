// SPDX-License-Identifier: Apache-2.0
#include "server/machine/systemd_copy.h"

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

TEST(SystemdCopy, LiesInTheFolderOfAService) {
  EXPECT_TRUE(IsSystemdCopy("/run/credentials/furrowd.service/keys"));
  EXPECT_TRUE(IsSystemdCopy("/run/credentials/furrowd@stage.service/tls.pem"));
  EXPECT_TRUE(IsSystemdCopy("/run/user/1000/credentials/furrowd.service/keys"));
}

TEST(SystemdCopy, IsNoOtherFile) {
  for (const char* const path :
       {"", "keys", "/", "/run", "/run/credentials", "/run/credentials/keys", "/etc/furrow/keys",
        "/run/credentials.old/furrowd.service/keys", "/srv/run/credentials/furrowd.service/keys",
        "/run/user/1000/furrow/keys", "/run/user/credentials/furrowd.service/keys"}) {
    EXPECT_FALSE(IsSystemdCopy(path)) << path;
  }
}

}  // namespace
}  // namespace furrow::server
