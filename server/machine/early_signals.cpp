// SPDX-License-Identifier: Apache-2.0
#include "server/machine/early_signals.h"

#include <atomic>
#include <csignal>

#include <unistd.h>

#include "server/machine/terminal.h"

namespace furrow::server::early_signals {
namespace {

std::atomic<bool> stop_noted = false;
std::atomic<bool> reload_noted = false;
std::atomic<bool> has_terminal = false;
static_assert(std::atomic<bool>::is_always_lock_free, "the handler may use nothing else");

void Note(int signal) {
  if (signal == SIGHUP && !has_terminal) {
    reload_noted = true;
  } else if (stop_noted.exchange(true)) {
    _exit(1);  // asked twice: something hangs
  }
}

}  // namespace

void Install() {
  has_terminal = HasTerminal();
  struct sigaction action = {};
  action.sa_handler = &Note;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) sigaction(signal, &action, nullptr);
}

bool stop() { return stop_noted; }
bool reload() { return reload_noted; }

}  // namespace furrow::server::early_signals
