// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/tls/client_tls.h"

#include <array>
#include <filesystem>
#include <system_error>

#include <arpa/inet.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include "protocol/framing/tcp_framing.h"

namespace furrow::client {
namespace {

// The file's fault, with the newest reason of OpenSSL.
Status FileFault(const std::string& file, const std::string& what, const std::string& todo) {
  const char* const reason = ERR_reason_error_string(ERR_peek_last_error());
  const std::string fault = reason == nullptr ? what : what + ": " + reason;
  ERR_clear_error();
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return {StatusCode::kNotFound, "no such file", file};
  return {StatusCode::kParse, fault, file, todo};
}

// OpenSSL would ask for a passphrase on the terminal.
int RefusePassphrase(char* /*buffer*/, int /*size*/, int /*writes*/, void* /*user*/) { return -1; }

Status UseAuthorities(const std::string& authority, SSL_CTX* context) {
  if (authority.empty()) {
    SSL_CTX_set_default_verify_paths(context);
  } else if (SSL_CTX_load_verify_file(context, authority.c_str()) != 1) {
    return FileFault(authority, "it is not a certificate in PEM form",
                     "give the certificate of the daemon, or of the authority that signed it");
  }
  return {};
}

Status UseCertificate(const ClientTlsFiles& files, SSL_CTX* context) {
  if (files.certificate.empty()) return {};
  const std::string& key = files.key.empty() ? files.certificate : files.key;
  if (SSL_CTX_use_certificate_chain_file(context, files.certificate.c_str()) != 1) {
    return FileFault(files.certificate, "it is not a certificate in PEM form",
                     "give the client's own certificate");
  }
  if (SSL_CTX_use_PrivateKey_file(context, key.c_str(), SSL_FILETYPE_PEM) != 1) {
    return FileFault(key, "it is not the private key of the certificate",
                     "give the key of the client's certificate, in PEM form without a passphrase");
  }
  return {};
}

bool IsNumeric(const std::string& host) {
  in6_addr bytes;  // large enough for both families
  return inet_pton(AF_INET, host.c_str(), &bytes) == 1 ||
         inet_pton(AF_INET6, host.c_str(), &bytes) == 1;
}

std::string CertificateFault(long result) {
  switch (result) {
    case X509_V_ERR_CERT_HAS_EXPIRED:
      return "its certificate has expired (renew it, or compare the clocks)";
    case X509_V_ERR_CERT_NOT_YET_VALID:
      return "its certificate is not valid yet (compare the clocks)";
    case X509_V_ERR_HOSTNAME_MISMATCH:
    case X509_V_ERR_IP_ADDRESS_MISMATCH:
      return "its certificate is for another host (connect by a name or an address that the "
             "certificate states)";
    case X509_V_ERR_DEPTH_ZERO_SELF_SIGNED_CERT:
    case X509_V_ERR_SELF_SIGNED_CERT_IN_CHAIN:
    case X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT:
    case X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT_LOCALLY:
    case X509_V_ERR_UNABLE_TO_VERIFY_LEAF_SIGNATURE:
      return "no known authority has signed its certificate (give the authority, or the "
             "certificate itself, with tls-authority=FILE or --tls-authority FILE)";
    default:
      return std::string("its certificate is invalid: ") + X509_verify_cert_error_string(result);
  }
}

}  // namespace

Result<std::shared_ptr<SSL_CTX>> MakeTlsContext(const ClientTlsFiles& files) {
  std::shared_ptr<SSL_CTX> context(SSL_CTX_new(TLS_client_method()), &SSL_CTX_free);
  if (context == nullptr) return Status(StatusCode::kInternal, "OpenSSL makes no context");
  SSL_CTX_set_min_proto_version(context.get(), TLS1_3_VERSION);
  SSL_CTX_set_verify(context.get(), SSL_VERIFY_PEER, nullptr);
  SSL_CTX_set_default_passwd_cb(context.get(), &RefusePassphrase);
  SSL_CTX_set_mode(context.get(), SSL_MODE_RELEASE_BUFFERS);
  SSL_CTX_set_alpn_protos(context.get(),
                          reinterpret_cast<const unsigned char*>(protocol::kTlsProtocols.data()),
                          static_cast<unsigned int>(protocol::kTlsProtocols.size()));
  X509_VERIFY_PARAM* const param = SSL_CTX_get0_param(context.get());
  // A certificate that the user names is trusted, even if another authority has signed it.
  X509_VERIFY_PARAM_set_flags(param, X509_V_FLAG_PARTIAL_CHAIN);
  X509_VERIFY_PARAM_set_hostflags(
      param, X509_CHECK_FLAG_NEVER_CHECK_SUBJECT | X509_CHECK_FLAG_NO_PARTIAL_WILDCARDS);
  ERR_clear_error();
  FURROW_RETURN_IF_ERROR(UseAuthorities(files.authority, context.get()));
  FURROW_RETURN_IF_ERROR(UseCertificate(files, context.get()));
  return context;
}

SSL* NewTlsClient(SSL_CTX* context, const std::string& host) {
  SSL* const ssl = SSL_new(context);
  if (ssl == nullptr) return nullptr;
  // "fe80::1%eth0" names an interface of this computer behind the address.
  const std::string name = host.substr(0, host.find('%'));
  bool good = true;
  if (IsNumeric(name)) {
    good = X509_VERIFY_PARAM_set1_ip_asc(SSL_get0_param(ssl), name.c_str()) == 1;
  } else {
    good =
        SSL_set1_host(ssl, name.c_str()) == 1 && SSL_set_tlsext_host_name(ssl, name.c_str()) == 1;
  }
  if (good) return ssl;
  SSL_free(ssl);
  return nullptr;
}

std::string TlsFailureText(const SSL* ssl, unsigned long code) {
  if (const long result = SSL_get_verify_result(ssl); result != X509_V_OK) {
    return CertificateFault(result);
  }
  switch (ERR_GET_LIB(code) == ERR_LIB_SSL ? ERR_GET_REASON(code) : 0) {
    case SSL_R_WRONG_VERSION_NUMBER:
    case SSL_R_PACKET_LENGTH_TOO_LONG:
      return "it does not speak TLS (leave out tls=1 and --tls, or start furrowd with "
             "--tls-certificate)";
    case SSL_R_TLSV13_ALERT_CERTIFICATE_REQUIRED:
      return "it asks for a certificate of the client (give it with tls-certificate=FILE and "
             "tls-key=FILE)";
    default: break;
  }
  const char* const reason = ERR_reason_error_string(code);
  return std::string("TLS failed: ") + (reason != nullptr ? reason : "unknown reason");
}

}  // namespace furrow::client
