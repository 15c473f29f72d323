// SPDX-License-Identifier: Apache-2.0
// The client's end of TLS against OpenSSL's server, in memory.
#include "client/cpp/tls/tls_session.h"

#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/ssl.h>

#include "client/cpp/tls/client_tls.h"
#include "tests/certificates.h"
#include "tests/temporary_folder.h"

namespace furrow::client {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Progress = TlsSession::Progress;
using testing::HasSubstr;

class TlsSessionTest : public testing::Test {
 protected:
  void SetUp() override {
    const std::string certificate = TestCertificate().Write(folder_.path(), "server");
    SSL_CTX_use_certificate_chain_file(server_context_.get(), certificate.c_str());
    SSL_CTX_use_PrivateKey_file(server_context_.get(), (folder_ / "server.key").c_str(),
                                SSL_FILETYPE_PEM);
    server_.reset(SSL_new(server_context_.get()));
    server_in_ = BIO_new(BIO_s_mem());
    server_out_ = BIO_new(BIO_s_mem());
    SSL_set_bio(server_.get(), server_in_, server_out_);
    SSL_set_accept_state(server_.get());
  }
  // A client that trusts `authority`.
  TlsSession MakeClient(const std::string& host, const std::string& authority) {
    auto context = MakeTlsContext({.authority = authority, .certificate = {}, .key = {}});
    EXPECT_TRUE(context.ok()) << context.status().ToString();
    client_context_ = *context;
    return {client_context_.get(), host};
  }
  void ToServer(TlsSession& session) {
    Bytes bytes;
    session.TakeOutgoing(&bytes);
    if (!bytes.empty()) BIO_write(server_in_, bytes.data(), static_cast<int>(bytes.size()));
  }
  // What the server has written since the last call.
  Bytes FromServer() {
    Bytes bytes(BIO_ctrl_pending(server_out_));
    if (!bytes.empty()) BIO_read(server_out_, bytes.data(), static_cast<int>(bytes.size()));
    return bytes;
  }
  Progress Shake(TlsSession& session) {
    for (int i = 0; i < 10; ++i) {
      const Progress progress = session.Handshake();
      ToServer(session);
      if (progress != Progress::kNeedsMore) return progress;
      (void)SSL_do_handshake(server_.get());
      session.Feed(FromServer());
    }
    return Progress::kNeedsMore;
  }
  template <class Type, auto kFree>
  struct Freer {
    void operator()(Type* object) const { kFree(object); }
  };

  TemporaryFolder folder_;
  std::unique_ptr<SSL_CTX, Freer<SSL_CTX, &SSL_CTX_free>> server_context_{
      SSL_CTX_new(TLS_server_method())};
  std::unique_ptr<SSL, Freer<SSL, &SSL_free>> server_;
  BIO* server_in_ = nullptr;  // owned by server_
  BIO* server_out_ = nullptr;
  std::shared_ptr<SSL_CTX> client_context_;
};

TEST_F(TlsSessionTest, CarriesDataBothWaysInAnyPieces) {
  TlsSession session = MakeClient("localhost", folder_ / "server.crt");
  ASSERT_EQ(Shake(session), Progress::kDone) << session.failure();
  Bytes message(100'000);
  for (std::size_t i = 0; i < message.size(); ++i) message[i] = static_cast<std::uint8_t>(i * 7);
  session.Encrypt(message);
  ToServer(session);
  ASSERT_EQ(SSL_do_handshake(server_.get()), 1);
  Bytes received(message.size());
  std::size_t size = 0;
  for (int got = 1; size < received.size() && got > 0; size += static_cast<std::size_t>(got)) {
    got = SSL_read(server_.get(), received.data() + size, static_cast<int>(received.size() - size));
    ASSERT_GT(got, 0);
  }
  EXPECT_EQ(received, message);
  // Back, in pieces that end within records.
  SSL_write(server_.get(), message.data(), static_cast<int>(message.size()));
  const Bytes sealed = FromServer();
  Bytes plain;
  Bytes all;
  for (std::size_t at = 0; at < sealed.size(); at += 1000) {
    session.Feed(std::span(sealed).subspan(at, std::min<std::size_t>(1000, sealed.size() - at)));
    ASSERT_TRUE(session.Decrypt(&plain)) << session.failure();
    all.insert(all.end(), plain.begin(), plain.end());
  }
  EXPECT_EQ(all, message);
}

TEST_F(TlsSessionTest, ChecksTheHost) {
  TlsSession session = MakeClient("elsewhere.example", folder_ / "server.crt");
  EXPECT_EQ(Shake(session), Progress::kFailed);
  EXPECT_THAT(session.failure(), HasSubstr("its certificate is for another host"));
}

TEST_F(TlsSessionTest, ChecksTheAuthority) {
  const std::string other = TestCertificate().Write(folder_.path(), "other");
  TlsSession session = MakeClient("localhost", other);
  EXPECT_EQ(Shake(session), Progress::kFailed);
  EXPECT_THAT(session.failure(), HasSubstr("no known authority"));
}

TEST_F(TlsSessionTest, APeerWithoutTlsIsNamed) {
  TlsSession session = MakeClient("localhost", folder_ / "server.crt");
  EXPECT_EQ(session.Handshake(), Progress::kNeedsMore);
  const std::string answer = "HTTP/1.1 400 Bad Request\r\n\r\n";
  session.Feed(std::span(reinterpret_cast<const std::uint8_t*>(answer.data()), answer.size()));
  EXPECT_EQ(session.Handshake(), Progress::kFailed);
  EXPECT_THAT(session.failure(), HasSubstr("does not speak TLS"));
}

TEST_F(TlsSessionTest, DataBeforeTheEndOfTheConnectionIsKept) {
  TlsSession session = MakeClient("localhost", folder_ / "server.crt");
  ASSERT_EQ(Shake(session), Progress::kDone) << session.failure();
  ASSERT_EQ(SSL_do_handshake(server_.get()), 1);
  const Bytes message = {1, 2, 3};
  SSL_write(server_.get(), message.data(), static_cast<int>(message.size()));
  SSL_shutdown(server_.get());
  session.Feed(FromServer());
  Bytes plain;
  EXPECT_FALSE(session.Decrypt(&plain));
  EXPECT_EQ(plain, message);
  EXPECT_EQ(session.failure(), "");
}

TEST_F(TlsSessionTest, ChangedBytesEndTheConnection) {
  TlsSession session = MakeClient("localhost", folder_ / "server.crt");
  ASSERT_EQ(Shake(session), Progress::kDone) << session.failure();
  ASSERT_EQ(SSL_do_handshake(server_.get()), 1);
  SSL_write(server_.get(), "abc", 3);
  Bytes sealed = FromServer();
  sealed.back() ^= 1;
  session.Feed(sealed);
  Bytes plain;
  EXPECT_FALSE(session.Decrypt(&plain));
  EXPECT_NE(session.failure(), "");
}

}  // namespace
}  // namespace furrow::client
