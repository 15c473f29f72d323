// SPDX-License-Identifier: Apache-2.0
#include "client/cli/common/interrupt.h"

#include <atomic>
#include <csignal>

namespace furrow::cli {
namespace {

std::atomic<bool> g_interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set in a signal handler");

void OnSignal(int number) {
  g_interrupted.store(true);
  // The next signal of this kind ends the process, if the command does not.
  std::signal(number, SIG_DFL);
}

}  // namespace

void CatchInterrupts() {
  std::signal(SIGINT, OnSignal);
  std::signal(SIGTERM, OnSignal);
}

bool Interrupted() { return g_interrupted.load(); }

}  // namespace furrow::cli
