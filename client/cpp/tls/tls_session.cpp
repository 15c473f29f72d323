// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/tls/tls_session.h"

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/ssl.h>

#include "client/cpp/tls/client_tls.h"

namespace furrow::client {
namespace {

constexpr std::size_t kRecordBytes = 16 * 1024;  // of TLS

}  // namespace

void TlsSession::Free::operator()(SSL* ssl) const { SSL_free(ssl); }

TlsSession::TlsSession(SSL_CTX* context, const std::string& host)
    : ssl_(NewTlsClient(context, host)) {
  if (ssl_ == nullptr) {
    failure_ = "TLS cannot check the name " + host;
    return;
  }
  in_ = BIO_new(BIO_s_mem());
  out_ = BIO_new(BIO_s_mem());
  SSL_set_bio(ssl_.get(), in_, out_);
  SSL_set_connect_state(ssl_.get());
}

void TlsSession::Fail() {
  failure_ = TlsFailureText(ssl_.get(), ERR_peek_error());
  ERR_clear_error();
}

TlsSession::Progress TlsSession::Handshake() {
  if (ssl_ == nullptr) return Progress::kFailed;
  ERR_clear_error();
  const int result = SSL_do_handshake(ssl_.get());
  if (result == 1) return Progress::kDone;
  if (SSL_get_error(ssl_.get(), result) == SSL_ERROR_WANT_READ) return Progress::kNeedsMore;
  Fail();
  return Progress::kFailed;
}

void TlsSession::Feed(std::span<const std::uint8_t> bytes) {
  BIO_write(in_, bytes.data(), static_cast<int>(bytes.size()));
}

bool TlsSession::Decrypt(std::vector<std::uint8_t>* plain) {
  plain->clear();
  ERR_clear_error();
  for (;;) {
    const std::size_t before = plain->size();
    plain->resize(before + kRecordBytes);
    const int got = SSL_read(ssl_.get(), plain->data() + before, static_cast<int>(kRecordBytes));
    plain->resize(before + static_cast<std::size_t>(got > 0 ? got : 0));
    if (got > 0) continue;
    const int error = SSL_get_error(ssl_.get(), got);
    if (error == SSL_ERROR_WANT_READ) return true;
    if (error != SSL_ERROR_ZERO_RETURN) Fail();
    return false;
  }
}

// A memory BIO takes everything, so the write is never partial.
void TlsSession::Encrypt(std::span<const std::uint8_t> bytes) {
  SSL_write(ssl_.get(), bytes.data(), static_cast<int>(bytes.size()));
}

void TlsSession::TakeOutgoing(std::vector<std::uint8_t>* bytes) {
  bytes->resize(out_ == nullptr ? 0 : BIO_ctrl_pending(out_));
  if (!bytes->empty()) BIO_read(out_, bytes->data(), static_cast<int>(bytes->size()));
}

}  // namespace furrow::client
