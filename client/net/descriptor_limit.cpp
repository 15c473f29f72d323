// SPDX-License-Identifier: Apache-2.0
#include "client/net/descriptor_limit.h"

#include <sys/resource.h>

namespace furrow::net {

void RaiseDescriptorLimit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur == limit.rlim_max) return;
  limit.rlim_cur = limit.rlim_max;
  (void)setrlimit(RLIMIT_NOFILE, &limit);  // on failure the old limit stays in force
}

}  // namespace furrow::net
