// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include <openssl/types.h>

#include "base/status.h"

namespace furrow::client {

// PEM files of a client. All are optional.
struct ClientTlsFiles {
  // The authorities that a daemon's certificate is checked with; the certificate itself will do.
  // Empty: the authorities that the system trusts.
  std::string authority;
  // The client's own certificate and its key, for daemons that ask for one. Both may be in the
  // first file.
  std::string certificate;
  std::string key;
};

// TLS 1.3 with the protocol furrow/1. Errors: kNotFound, kIo, kParse, kInvalidArgument (the key
// does not belong to the certificate); `where` is the file.
[[nodiscard]] Result<std::shared_ptr<SSL_CTX>> MakeTlsContext(const ClientTlsFiles& files);

// One connection to `host`, a name or a numeric address, that the daemon's certificate must be for.
// The caller owns the result; null: out of memory.
[[nodiscard]] SSL* NewTlsClient(SSL_CTX* context, const std::string& host);

// The time for a connect with its handshake. A daemon gives a client 5 s to find its turn among the
// clients of its host, and then closes the connection.
inline constexpr std::chrono::milliseconds kTlsConnectTimeout{7000};

// Why TLS failed, and what to do, as part of a sentence: "its certificate has expired (...)".
// `code`: of OpenSSL.
[[nodiscard]] std::string TlsFailureText(const SSL* ssl, unsigned long code);

}  // namespace furrow::client
