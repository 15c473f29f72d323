// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "base/status.h"

namespace furrow::bench {

// Prints why and ends, with exit status 1: a benchmark has nothing to clean up but processes that
// end with it.
[[noreturn]] void FailWith(const Status& status);

// The value, or the end.
template <class T>
[[nodiscard]] T Take(Result<T> result) {
  if (!result.ok()) FailWith(result.status());
  return *std::move(result);
}

}  // namespace furrow::bench
