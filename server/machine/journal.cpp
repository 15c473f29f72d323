// SPDX-License-Identifier: Apache-2.0
#include "server/machine/journal.h"

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

bool StderrIsJournal() {
  const char* const stream = std::getenv("JOURNAL_STREAM");
  return stream != nullptr && IsJournal(STDERR_FILENO, stream);
}

}  // namespace furrow::server
