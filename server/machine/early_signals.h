// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace furrow::server {

// Notes SIGTERM, SIGINT and SIGHUP that arrive while a daemon starts, until its event loop handles
// them. Otherwise they would end the process with the wrong exit code or, if it is the first of a
// container, be lost.
namespace early_signals {

// For the whole process. Call it once, before the first thread. The second signal that stops ends
// the process at once, with exit code 1.
void Install();
// True after SIGTERM or SIGINT, or after the SIGHUP of a terminal that closes.
[[nodiscard]] bool stop();
// True after SIGHUP without a terminal.
[[nodiscard]] bool reload();

}  // namespace early_signals
}  // namespace furrow::server
