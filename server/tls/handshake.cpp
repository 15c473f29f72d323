// SPDX-License-Identifier: Apache-2.0
#include "server/tls/handshake.h"

#include <openssl/err.h>
#include <openssl/ssl.h>

namespace furrow::server {
namespace {

// A number that OpenSSL adds to the reasons of alerts that the other side has sent.
constexpr int kFirstAlert = SSL_AD_REASON_OFFSET;

}  // namespace

bool LooksLikeTls(std::span<const std::uint8_t> bytes) {
  constexpr std::uint8_t kHandshake = 22;
  constexpr std::uint8_t kMajor = 3;
  constexpr std::uint8_t kLastMinor = 4;
  return (bytes.empty() || bytes[0] == kHandshake) && (bytes.size() < 2 || bytes[1] == kMajor) &&
         (bytes.size() < kTlsPrefixBytes || bytes[2] <= kLastMinor);
}

Counter HandshakeFailure(unsigned long code) {
  if (ERR_GET_LIB(code) != ERR_LIB_SSL) return Counter::kTlsFailed;
  const int reason = ERR_GET_REASON(code);
  switch (reason) {
    case SSL_R_PEER_DID_NOT_RETURN_A_CERTIFICATE: return Counter::kTlsNoCertificate;
    case SSL_R_CERTIFICATE_VERIFY_FAILED: return Counter::kTlsBadCertificate;
    case SSL_R_UNSUPPORTED_PROTOCOL:
    case SSL_R_VERSION_TOO_LOW:
    case SSL_R_WRONG_VERSION_NUMBER: return Counter::kTlsOldVersion;
    case SSL_R_NO_APPLICATION_PROTOCOL: return Counter::kTlsWrongProtocol;
    default: return reason >= kFirstAlert ? Counter::kTlsRefusedByClient : Counter::kTlsFailed;
  }
}

// A host that has used up its own budget takes nothing from that of all.
bool HandshakeBudget::Take(const std::string& host, Time now) {
  if (!hosts_.Take(host, now)) return false;
  if (total_.Take(ToMicroseconds(now))) return true;
  return reserves_.Take(host, now) && reserve_.Take(ToMicroseconds(now));
}

}  // namespace furrow::server
