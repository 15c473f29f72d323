// SPDX-License-Identifier: Apache-2.0
#include "server/session/access/key_file.h"

#include <utility>

#include <spdlog/spdlog.h>

#include "base/text.h"

namespace furrow::server {

using protocol::secure::KeyRing;
using protocol::secure::LoadKeyRing;

KeyFile::KeyFile(std::filesystem::path path) : path_(std::move(path)), watch_(path_) {}

Result<KeyRing> KeyFile::Load() {
  if (path_.empty()) return KeyRing();
  (void)watch_.Changed();  // before it is read, so that no change is missed
  auto keys = LoadKeyRing(path_);
  if (keys.ok() && keys->keys().empty()) {
    spdlog::warn("the key file has no key, so no token is valid");
  }
  return keys;
}

std::optional<KeyRing> KeyFile::ReadIfChanged() {
  const bool changed = watch_.Changed();
  if (!changed && !failed_) return std::nullopt;
  auto keys = LoadKeyRing(path_);
  failed_ = !keys.ok();
  if (failed_) {
    if (changed) spdlog::error("the keys stay as they were: {}", keys.status().ToString());
    return std::nullopt;
  }
  spdlog::info("read {} from {}", Counted(keys->keys().size(), "key"), path_.string());
  return *std::move(keys);
}

}  // namespace furrow::server
