// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <openssl/types.h>

#include "base/status.h"
#include "server/tls/tls_files.h"

namespace furrow::server {

// What a TLS connection of the daemon is made from. A connection keeps its context, so another one
// can take its place at any time.
using TlsContext = std::shared_ptr<SSL_CTX>;

// TLS 1.3, without tickets and early data. Each port accepts its own protocol only (ALPN), so that
// nobody can redirect a client of one port to the other one. Clients that name no protocol are
// accepted.
struct TlsContexts {
  TlsContext messages;  // for the TCP port: furrow/1; clients must show a certificate if any
  TlsContext web;       // for the web port: http/1.1; a certificate is checked if one is shown
  std::string warning;  // a certificate that clients will refuse, such as an expired one; or empty
};

// Reads the files. Errors: kNotFound, kIo, kParse (no PEM of that kind), kInvalidArgument (an
// encrypted key, or one that does not belong to the certificate); `where` is the file.
[[nodiscard]] Result<TlsContexts> LoadTlsContexts(const TlsFiles& files);

}  // namespace furrow::server
