// SPDX-License-Identifier: Apache-2.0
#include "server/machine/journal.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <string>

#include <sys/stat.h>
#include <unistd.h>

namespace furrow::server {

bool IsJournal(int descriptor, std::string_view journal_stream) {
  struct stat info {};
  if (fstat(descriptor, &info) != 0) return false;
  return journal_stream == std::to_string(info.st_dev) + ":" + std::to_string(info.st_ino);
}

std::string AsJournalError(std::string_view text) {
  std::string marked;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
    marked.append("<3>").append(text.substr(0, end));
    text.remove_prefix(end);
  }
  return marked;
}

bool StderrIsJournal() {
  const char* const stream = std::getenv("JOURNAL_STREAM");
  return stream != nullptr && IsJournal(STDERR_FILENO, stream);
}

}  // namespace furrow::server
