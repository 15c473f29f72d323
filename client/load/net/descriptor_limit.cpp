// SPDX-License-Identifier: Apache-2.0
#include "client/load/net/descriptor_limit.h"

#include <sys/resource.h>

namespace furrow::load {

void RaiseDescriptorLimit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur == limit.rlim_max) return;
  limit.rlim_cur = limit.rlim_max;
  (void)setrlimit(RLIMIT_NOFILE, &limit);  // refused: the sockets that fit are what there is
}

}  // namespace furrow::load
