// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "base/status.h"
#include "protocol/secure/token/key_ring.h"
#include "server/core/file_watch.h"

namespace furrow::server {

// The key file of a running daemon.
class KeyFile {
 public:
  // An empty path: there is no file.
  explicit KeyFile(std::filesystem::path path);

  // The keys at the start; none without a file. Errors: those of protocol::secure::LoadKeyRing().
  [[nodiscard]] Result<protocol::secure::KeyRing> Load();
  // The keys, if they were not read since the file changed. Call it about once per second.
  //
  // A file that cannot be read changes nothing: an editor may be writing it. It is tried again
  // until it can be read, because what was wrong may end without a change of the file: its rights,
  // or a lack of descriptors. Otherwise a key that was retired would stay. The fault is logged
  // once per change.
  [[nodiscard]] std::optional<protocol::secure::KeyRing> ReadIfChanged();

 private:
  std::filesystem::path path_;
  FileWatch watch_;
  bool failed_ = false;  // the changed file could not be read yet
};

}  // namespace furrow::server
