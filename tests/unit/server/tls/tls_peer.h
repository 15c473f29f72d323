// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include <openssl/bio.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>

#include "tests/certificates.h"

namespace furrow::server {

using Ssl = std::unique_ptr<SSL, void (*)(SSL*)>;
using SslContext = std::unique_ptr<SSL_CTX, void (*)(SSL_CTX*)>;

// A context of a server with the certificate.
[[nodiscard]] inline SslContext ServerContext(const TestCertificate& certificate) {
  SslContext context(SSL_CTX_new(TLS_server_method()), &SSL_CTX_free);
  const auto read = [](const std::string& text, auto parse) {
    BIO* const bio = BIO_new_mem_buf(text.data(), static_cast<int>(text.size()));
    auto* const parsed = parse(bio, nullptr, nullptr, nullptr);
    BIO_free(bio);
    return parsed;
  };
  X509* const chain = read(certificate.CertificateText(), &PEM_read_bio_X509);
  EVP_PKEY* const key = read(certificate.KeyText(), &PEM_read_bio_PrivateKey);
  SSL_CTX_use_certificate(context.get(), chain);
  SSL_CTX_use_PrivateKey(context.get(), key);
  X509_free(chain);
  EVP_PKEY_free(key);
  SSL_CTX_set_min_proto_version(context.get(), TLS1_3_VERSION);
  SSL_CTX_set_num_tickets(context.get(), 0);
  SSL_CTX_set_session_cache_mode(context.get(), SSL_SESS_CACHE_OFF);
  SSL_CTX_set_options(context.get(), SSL_OP_NO_TICKET);
  return context;
}

// A client without a socket: the test carries what it says and hears.
class TlsPeer {
 public:
  TlsPeer()
      : context_(SSL_CTX_new(TLS_client_method()), &SSL_CTX_free),
        ssl_(SSL_new(context_.get()), &SSL_free),
        in_(BIO_new(BIO_s_mem())),
        out_(BIO_new(BIO_s_mem())) {
    SSL_set_bio(ssl_.get(), in_, out_);
    SSL_set_connect_state(ssl_.get());
    BIO_set_mem_eof_return(in_, -1);
  }

  // Goes on with the handshake. True: it is over.
  bool Handshake() { return SSL_do_handshake(ssl_.get()) == 1; }
  // Encrypts one record of at most 16 KiB.
  void Say(std::string_view text) {
    EXPECT_EQ(SSL_write(ssl_.get(), text.data(), static_cast<int>(text.size())),
              static_cast<int>(text.size()));
  }
  // Ends TLS.
  void SayGoodbye() { SSL_shutdown(ssl_.get()); }
  // What the client wants to send; `most`: bytes of it.
  [[nodiscard]] std::string Outgoing(std::size_t most = std::string::npos) {
    std::string bytes(std::min(most, BIO_ctrl_pending(out_)), '\0');
    if (!bytes.empty()) BIO_read(out_, bytes.data(), static_cast<int>(bytes.size()));
    return bytes;
  }
  void Hear(std::string_view bytes) {
    if (!bytes.empty()) BIO_write(in_, bytes.data(), static_cast<int>(bytes.size()));
  }
  // What the server has said so far, decrypted.
  [[nodiscard]] std::string Heard() {
    std::string all;
    char bytes[4096];
    for (int size = 0; (size = SSL_read(ssl_.get(), bytes, sizeof(bytes))) > 0;) {
      all.append(bytes, static_cast<std::size_t>(size));
    }
    return all;
  }
  // True: the server has ended TLS. Call Heard() before.
  [[nodiscard]] bool HeardGoodbye() const {
    return (SSL_get_shutdown(ssl_.get()) & SSL_RECEIVED_SHUTDOWN) != 0;
  }

 private:
  SslContext context_;
  Ssl ssl_;
  BIO* in_;
  BIO* out_;
};

}  // namespace furrow::server
