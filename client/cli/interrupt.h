// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace furrow::cli {

// From here on SIGINT and SIGTERM ask the command to end well (say goodbye, exit 0) rather than
// killing it. The second one kills.
void CatchInterrupts();

// True once a signal has come.
[[nodiscard]] bool Interrupted();

}  // namespace furrow::cli
