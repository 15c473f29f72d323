// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include <openssl/types.h>

#include "protocol/secure/token/connect_token.h"

namespace furrow::client {

// How a client proves who it is, and how it protects what it sends.
struct Security {
  // Shown to the daemon. Over UDP it encrypts everything.
  std::optional<protocol::secure::ClientToken> token;
  // TLS over TCP (MakeTlsContext()); null: plain TCP.
  std::shared_ptr<SSL_CTX> tls;
  // `tls` checks with an authority that the user has named, not with those of the system.
  bool own_authority = false;
  // Permits the token over plain TCP to other computers. Everybody on the way can read it there.
  bool token_in_clear = false;
};

}  // namespace furrow::client
