// SPDX-License-Identifier: Apache-2.0
#include "server/tls/tls_context.h"

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>

#include "base/files.h"
#include "protocol/framing/tcp_framing.h"

namespace furrow::server {
namespace {

constexpr std::uint64_t kMaxPemBytes = 1 << 20;
// Of the certificates that a client shows. Usual chains have 2 to 4 kB.
constexpr long kMaxClientChainBytes = 16 * 1024;

struct Free {
  void operator()(BIO* bio) const { BIO_free(bio); }
  void operator()(X509* certificate) const { X509_free(certificate); }
  void operator()(EVP_PKEY* key) const { EVP_PKEY_free(key); }
};
using Bio = std::unique_ptr<BIO, Free>;
using Certificate = std::unique_ptr<X509, Free>;
using PrivateKey = std::unique_ptr<EVP_PKEY, Free>;

// As protocol::kTlsProtocols, of the web port.
constexpr std::string_view kWebProtocols =
    "\x08"
    "http/1.1";

int SelectProtocol(SSL* /*ssl*/, const unsigned char** chosen, unsigned char* chosen_bytes,
                   const unsigned char* offered, unsigned int offered_bytes, void* own) {
  const auto& protocols = *static_cast<const std::string_view*>(own);
  unsigned char* selected = nullptr;
  const int result = SSL_select_next_proto(
      &selected, chosen_bytes, reinterpret_cast<const unsigned char*>(protocols.data()),
      static_cast<unsigned int>(protocols.size()), offered, offered_bytes);
  *chosen = selected;
  return result == OPENSSL_NPN_NEGOTIATED ? SSL_TLSEXT_ERR_OK : SSL_TLSEXT_ERR_ALERT_FATAL;
}

// OpenSSL would ask for a passphrase on the terminal.
int RefusePassphrase(char* /*buffer*/, int /*size*/, int /*writes*/, void* asked) {
  *static_cast<bool*>(asked) = true;
  return -1;
}

// The newest reason of OpenSSL, and an empty list of errors for the next one.
std::string Reason() {
  const char* const reason = ERR_reason_error_string(ERR_peek_last_error());
  ERR_clear_error();
  return reason != nullptr ? reason : "unknown reason";
}

Status Fault(StatusCode code, std::string what, const std::filesystem::path& file,
             std::string todo = {}) {
  ERR_clear_error();
  return {code, std::move(what), file.string(), std::move(todo)};
}

Result<std::vector<Certificate>> ReadCertificates(const std::filesystem::path& file) {
  const Result<std::string> text = ReadFile(file, kMaxPemBytes);
  FURROW_RETURN_IF_ERROR(text);
  const Bio bio(BIO_new_mem_buf(text->data(), static_cast<int>(text->size())));
  std::vector<Certificate> certificates;
  while (X509* next = PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr)) {
    certificates.emplace_back(next);
  }
  // The end of the file is an error, too, but the only one that is expected.
  const bool ended = ERR_GET_REASON(ERR_peek_last_error()) == PEM_R_NO_START_LINE;
  if (!certificates.empty() && ended) {
    ERR_clear_error();
    return certificates;
  }
  return Fault(StatusCode::kParse, "it is not a certificate in PEM form", file,
               "a PEM file begins with -----BEGIN CERTIFICATE-----");
}

Result<PrivateKey> ReadKey(const std::filesystem::path& file) {
  const Result<std::string> text = ReadFile(file, kMaxPemBytes);
  FURROW_RETURN_IF_ERROR(text);
  const Bio bio(BIO_new_mem_buf(text->data(), static_cast<int>(text->size())));
  bool asked = false;
  PrivateKey key(PEM_read_bio_PrivateKey(bio.get(), nullptr, &RefusePassphrase, &asked));
  if (key != nullptr) return key;
  if (asked) {
    return Fault(StatusCode::kInvalidArgument, "the key has a passphrase", file,
                 "remove it: openssl pkey -in FILE -out NEW_FILE");
  }
  return Fault(StatusCode::kParse, "it is not a private key in PEM form", file,
               "a PEM file begins with -----BEGIN PRIVATE KEY-----");
}

void SetCommonOptions(SSL_CTX* context, const std::string_view& protocols) {
  SSL_CTX_set_min_proto_version(context, TLS1_3_VERSION);
  // A session that resumes would outlive a change of the client authority.
  SSL_CTX_set_num_tickets(context, 0);
  SSL_CTX_set_session_cache_mode(context, SSL_SESS_CACHE_OFF);
  SSL_CTX_set_options(context, SSL_OP_NO_TICKET);
  SSL_CTX_set_mode(context, SSL_MODE_RELEASE_BUFFERS);
  SSL_CTX_set_max_cert_list(context, kMaxClientChainBytes);
  SSL_CTX_set_alpn_select_cb(context, &SelectProtocol, const_cast<std::string_view*>(&protocols));
}

// What the files contain.
struct Material {
  std::vector<Certificate> chain;  // not empty; that of the daemon is the first
  PrivateKey key;
  std::vector<Certificate> client_authorities;
};

// `protocols`: lives as long as the program.
Result<TlsContext> MakeContext(const TlsFiles& files, const Material& material,
                               const std::string_view& protocols, int verify_mode) {
  TlsContext context(SSL_CTX_new(TLS_server_method()), &SSL_CTX_free);
  if (context == nullptr) return Fault(StatusCode::kInternal, Reason(), files.certificate);
  SetCommonOptions(context.get(), protocols);
  if (SSL_CTX_use_certificate(context.get(), material.chain.front().get()) != 1) {
    return Fault(StatusCode::kInvalidArgument, "it cannot be used: " + Reason(), files.certificate);
  }
  for (std::size_t i = 1; i < material.chain.size(); ++i) {
    SSL_CTX_add1_chain_cert(context.get(), material.chain[i].get());
  }
  if (X509_check_private_key(material.chain.front().get(), material.key.get()) != 1) {
    return Fault(StatusCode::kInvalidArgument, "the key does not belong to the certificate",
                 files.key, "use the key with which the certificate was made");
  }
  if (SSL_CTX_use_PrivateKey(context.get(), material.key.get()) != 1) {
    return Fault(StatusCode::kInvalidArgument, "it cannot be used: " + Reason(), files.key);
  }
  for (const Certificate& authority : material.client_authorities) {
    X509_STORE_add_cert(SSL_CTX_get_cert_store(context.get()), authority.get());
    SSL_CTX_add_client_CA(context.get(), authority.get());
  }
  if (!material.client_authorities.empty()) {
    SSL_CTX_set_verify(context.get(), verify_mode, nullptr);
  }
  return context;
}

// What clients will dislike about the certificate; empty: nothing.
std::string WarningAbout(const TlsFiles& files, X509* certificate) {
  const std::string name = files.certificate.string();
  if (X509_cmp_current_time(X509_get0_notAfter(certificate)) < 0) {
    return name + ": the certificate has expired, so clients refuse it: make a new one";
  }
  if (X509_cmp_current_time(X509_get0_notBefore(certificate)) > 0) {
    return name + ": the certificate is not valid yet, so clients refuse it: check the clock";
  }
  if (X509_get_ext_by_NID(certificate, NID_subject_alt_name, -1) < 0) {
    return name +
           ": the certificate names no host (subjectAltName), so clients refuse it: make one with "
           "the names and addresses of this computer";
  }
  return {};
}

}  // namespace

Result<TlsContexts> LoadTlsContexts(const TlsFiles& files) {
  Material material;
  auto chain = ReadCertificates(files.certificate);
  FURROW_RETURN_IF_ERROR(chain);
  material.chain = *std::move(chain);
  auto key = ReadKey(files.key);
  FURROW_RETURN_IF_ERROR(key);
  material.key = *std::move(key);
  if (!files.client_authority.empty()) {
    auto authorities = ReadCertificates(files.client_authority);
    FURROW_RETURN_IF_ERROR(authorities);
    material.client_authorities = *std::move(authorities);
  }
  // Probes of supervisors show no certificate, so the web port asks for one by request.
  auto messages = MakeContext(files, material, protocol::kTlsProtocols,
                              SSL_VERIFY_PEER | SSL_VERIFY_FAIL_IF_NO_PEER_CERT);
  FURROW_RETURN_IF_ERROR(messages);
  auto web = MakeContext(files, material, kWebProtocols, SSL_VERIFY_PEER);
  FURROW_RETURN_IF_ERROR(web);
  return TlsContexts{*std::move(messages), *std::move(web),
                     WarningAbout(files, material.chain.front().get())};
}

}  // namespace furrow::server
