// SPDX-License-Identifier: Apache-2.0
#include "client/cli/common/exit_code.h"

#include <cstdio>

namespace furrow::cli {

int Fail(const Status& status) {
  std::fprintf(stderr, "furrow: %s\n", status.ToString().c_str());
  switch (status.code()) {
    case StatusCode::kIo:
    case StatusCode::kUnavailable:
    case StatusCode::kInternal: return kFailed;
    default: return kBadInput;
  }
}

}  // namespace furrow::cli
