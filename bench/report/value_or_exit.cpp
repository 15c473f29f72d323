// SPDX-License-Identifier: Apache-2.0
#include "bench/report/value_or_exit.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>

namespace furrow::bench {

void FailWith(const Status& status) {
  std::fprintf(stderr, "%s: %s\n", program_invocation_short_name, status.ToString().c_str());
  std::exit(1);
}

}  // namespace furrow::bench
