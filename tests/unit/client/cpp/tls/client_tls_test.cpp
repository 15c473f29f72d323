// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/tls/client_tls.h"

#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/err.h>
#include <openssl/ssl.h>

#include "tests/certificates.h"
#include "tests/temporary_folder.h"

namespace furrow::client {
namespace {

using testing::HasSubstr;

class ClientTls : public testing::Test {
 protected:
  void SetUp() override { TestCertificate().Write(folder.path(), "a"); }
  [[nodiscard]] std::string Path(const std::string& name) const { return folder / name; }
  // Where and why the files cannot be used; empty: they can.
  static std::string Fault(const ClientTlsFiles& files) {
    const auto context = MakeTlsContext(files);
    EXPECT_EQ(ERR_peek_error(), 0u) << "a later handshake would report this error";
    return context.ok() ? "" : context.status().where() + ": " + context.status().what();
  }

  TemporaryFolder folder;
};

TEST_F(ClientTls, ReadsAnAuthorityAndACertificateWithItsKey) {
  EXPECT_EQ(Fault({}), "") << "the authorities of the system";
  EXPECT_EQ(Fault({.authority = Path("a.crt"), .certificate = {}, .key = {}}), "");
  EXPECT_EQ(Fault({.authority = {}, .certificate = Path("a.crt"), .key = Path("a.key")}), "");
  const TestCertificate both;
  std::ofstream(folder / "both.pem") << both.CertificateText() << both.KeyText();
  EXPECT_EQ(Fault({.authority = {}, .certificate = Path("both.pem"), .key = {}}), "");
}

TEST_F(ClientTls, NamesTheFileThatIsWrong) {
  EXPECT_THAT(Fault({.authority = "/nowhere.crt", .certificate = {}, .key = {}}),
              HasSubstr("/nowhere.crt: "));
  EXPECT_THAT(Fault({.authority = Path("a.key"), .certificate = {}, .key = {}}),
              HasSubstr("a.key: it is not a certificate"));
  EXPECT_THAT(Fault({.authority = {}, .certificate = Path("a.crt"), .key = {}}),
              HasSubstr("a.crt: it is not the private key"));
  TestCertificate().Write(folder.path(), "b");
  EXPECT_THAT(Fault({.authority = {}, .certificate = Path("a.crt"), .key = Path("b.key")}),
              HasSubstr("b.key: it is not the private key of the certificate"));
  std::ofstream(folder / "a.key") << TestCertificate().KeyText("secret");
  EXPECT_THAT(Fault({.authority = {}, .certificate = Path("a.crt"), .key = Path("a.key")}),
              HasSubstr("a.key: "))
      << "and asks nobody for a passphrase";
}

TEST_F(ClientTls, AConnectionIsForANameOrAnAddress) {
  const auto context = MakeTlsContext({});
  ASSERT_TRUE(context.ok());
  for (const char* host : {"stage.example", "127.0.0.1", "::1", "fe80::1%eth0"}) {
    const std::unique_ptr<SSL, void (*)(SSL*)> ssl(NewTlsClient(context->get(), host), &SSL_free);
    ASSERT_NE(ssl, nullptr) << host;
    // A server name is a name, never an address (RFC 6066 section 3).
    const char* const name = SSL_get_servername(ssl.get(), TLSEXT_NAMETYPE_host_name);
    EXPECT_EQ(name != nullptr, host == std::string("stage.example")) << host;
  }
}

TEST_F(ClientTls, FailuresSayWhatToDo) {
  const auto context = MakeTlsContext({});
  ASSERT_TRUE(context.ok());
  const std::unique_ptr<SSL, void (*)(SSL*)> ssl(NewTlsClient(context->get(), "a"), &SSL_free);
  const auto text = [&](int reason) {
    return TlsFailureText(ssl.get(), ERR_PACK(ERR_LIB_SSL, 0, reason));
  };
  EXPECT_THAT(TlsFailureText(ssl.get(), ERR_PACK(ERR_LIB_ASN1, 0, 1)), HasSubstr("TLS failed: "));
  EXPECT_THAT(text(SSL_R_WRONG_VERSION_NUMBER), HasSubstr("start furrowd with --tls-certificate"));
  EXPECT_THAT(text(SSL_R_TLSV13_ALERT_CERTIFICATE_REQUIRED), HasSubstr("tls-certificate=FILE"));
  EXPECT_THAT(text(SSL_R_BAD_EXTENSION), HasSubstr("TLS failed: bad extension"));
  SSL_set_verify_result(ssl.get(), X509_V_ERR_CERT_HAS_EXPIRED);
  EXPECT_THAT(text(SSL_R_CERTIFICATE_VERIFY_FAILED), HasSubstr("has expired"));
  SSL_set_verify_result(ssl.get(), X509_V_ERR_IP_ADDRESS_MISMATCH);
  EXPECT_THAT(text(SSL_R_CERTIFICATE_VERIFY_FAILED), HasSubstr("is for another host"));
}

}  // namespace
}  // namespace furrow::client
