// SPDX-License-Identifier: Apache-2.0
#include "server/session/access/key_file.h"

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <utility>

#include <spdlog/spdlog.h>

#include "base/text.h"

namespace furrow::server {

using protocol::secure::KeyRing;
using protocol::secure::LoadKeyRing;

namespace {

// An operator may not notice otherwise that nobody can come in.
void WarnIfNobodyMayEnter(const KeyRing& keys) {
  const auto now = static_cast<std::uint64_t>(std::time(nullptr));
  const auto is_valid = [now](const protocol::secure::TokenKey& key) { return key.expires > now; };
  if (keys.keys().empty()) {
    spdlog::warn("the key file has no key, so no token is valid");
  } else if (std::ranges::none_of(keys.keys(), is_valid)) {
    spdlog::warn("all keys of the key file have expired, so no token is valid");
  }
}

}  // namespace

KeyFile::KeyFile(std::filesystem::path path) : path_(std::move(path)), watch_(path_) {}

Result<KeyRing> KeyFile::Load() {
  if (path_.empty()) return KeyRing();
  (void)watch_.Changed();  // before it is read, so that no change is missed
  auto keys = LoadKeyRing(path_);
  if (keys.ok()) WarnIfNobodyMayEnter(*keys);
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
  WarnIfNobodyMayEnter(*keys);
  return *std::move(keys);
}

}  // namespace furrow::server
