// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace furrow::cli {

// Makes the first SIGINT or SIGTERM set a flag, so that the command can finish cleanly and exit
// with 0. The second signal kills the process.
void CatchInterrupts();

// True after a signal has arrived.
[[nodiscard]] bool Interrupted();

}  // namespace furrow::cli
