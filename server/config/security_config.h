// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "server/core/security.h"
#include "server/tls/tls_files.h"

namespace furrow::server {

// Which clients are let in (docs/TOKENS.md, docs/SECURITY.md).
struct SecurityConfig {
  Security mode = Security::kOpen;
  std::filesystem::path keys;    // key file of `furrow token`; empty: no token is valid
  std::string name;              // of this daemon: tokens with another --audience are refused
  bool tokens_in_clear = false;  // accept tokens over plain TCP and HTTP from other computers
  TlsFiles tls;                  // without them, TCP and HTTP are plain
  bool confine = true;           // give up what the daemon does not need (Confine())
  friend bool operator==(const SecurityConfig&, const SecurityConfig&) = default;
};

}  // namespace furrow::server
