// SPDX-License-Identifier: Apache-2.0
#include "server/machine/early_signals.h"

#include <csignal>

namespace furrow::server::early_signals {
namespace {

volatile std::sig_atomic_t stop_noted = 0;
volatile std::sig_atomic_t reload_noted = 0;

void Note(int signal) {
  if (signal == SIGHUP) {
    reload_noted = 1;
  } else {
    stop_noted = 1;
  }
}

}  // namespace

void Install() {
  struct sigaction action = {};
  action.sa_handler = &Note;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) sigaction(signal, &action, nullptr);
}

bool stop() { return stop_noted != 0; }
bool reload() { return reload_noted != 0; }

}  // namespace furrow::server::early_signals
