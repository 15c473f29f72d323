// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace furrow::server {

// The PEM files that make the TCP port and the web port speak TLS (docs/SECURITY.md).
struct TlsFiles {
  std::filesystem::path certificate;  // of the daemon, followed by its intermediate authorities
  std::filesystem::path key;          // of the certificate, without a passphrase
  // The authorities that sign the certificates of clients; empty: clients need no certificate.
  std::filesystem::path client_authority;

  // False: the ports speak plain TCP and HTTP.
  [[nodiscard]] bool enabled() const { return !certificate.empty(); }
  friend bool operator==(const TlsFiles&, const TlsFiles&) = default;
};

}  // namespace furrow::server
