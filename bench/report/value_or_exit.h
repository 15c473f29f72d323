// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "base/status.h"

namespace furrow::bench {

// Prints the failure and exits with status 1. A benchmark needs no clean-up: the processes that it
// started end with it.
[[noreturn]] void FailWith(const Status& status);

// Returns the value, or exits the program with the failure.
template <class T>
[[nodiscard]] T ValueOrExit(Result<T> result) {
  if (!result.ok()) FailWith(result.status());
  return *std::move(result);
}

}  // namespace furrow::bench
