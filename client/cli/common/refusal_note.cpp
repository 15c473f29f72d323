// SPDX-License-Identifier: Apache-2.0
#include "client/cli/common/refusal_note.h"

#include <cstdio>

namespace furrow::cli {

void RefusalNote::Show(const std::string& refusal) {
  if (refusal.empty() || !shown_.insert(refusal).second) return;
  std::fprintf(stderr, "furrow: %s; trying again\n", refusal.c_str());
}

}  // namespace furrow::cli
