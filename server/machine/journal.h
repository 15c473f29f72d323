// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace furrow::server {

// True if this file descriptor is the stream to systemd's journal that JOURNAL_STREAM names:
// "<device>:<inode>" (systemd.exec(5)). Somebody may have redirected the descriptor since.
[[nodiscard]] bool IsJournal(int descriptor, std::string_view journal_stream);

// The same for standard error and the environment of this process.
[[nodiscard]] bool StderrIsJournal();

// A message of several lines with the priority of an error, which journald reads and removes.
[[nodiscard]] std::string AsJournalError(std::string_view text);

}  // namespace furrow::server
