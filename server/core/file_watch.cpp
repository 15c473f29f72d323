// SPDX-License-Identifier: Apache-2.0
#include "server/core/file_watch.h"

#include <sys/stat.h>

namespace furrow::server {

bool FileWatch::Changed() {
  struct stat info;
  if (path_.empty() || stat(path_.c_str(), &info) != 0) return false;
  const Mark now{info.st_mtim.tv_sec, info.st_mtim.tv_nsec, info.st_size, info.st_ino};
  return std::exchange(last_, now) != now;
}

}  // namespace furrow::server
