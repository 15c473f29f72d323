// SPDX-License-Identifier: Apache-2.0
#include "server/tls/tls_context.h"

#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/err.h>

#include "tests/certificates.h"
#include "tests/temporary_folder.h"

namespace furrow::server {
namespace {

using testing::HasSubstr;

class TlsContextTest : public testing::Test {
 protected:
  void SetUp() override { certificate.Write(folder.path(), "a"); }
  void Replace(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name) << text;
  }
  [[nodiscard]] Status Load() const { return LoadTlsContexts(files).status(); }

  const TestCertificate certificate;
  TemporaryFolder folder;
  TlsFiles files{.certificate = folder / "a.crt", .key = folder / "a.key", .client_authority = {}};
};

TEST_F(TlsContextTest, ReadsACertificateItsKeyAndAuthorities) {
  const auto contexts = LoadTlsContexts(files);
  ASSERT_TRUE(contexts.ok()) << contexts.status().ToString();
  EXPECT_NE(contexts->messages, nullptr);
  EXPECT_NE(contexts->web, nullptr);
  EXPECT_EQ(contexts->warning, "");
  files.client_authority = files.certificate;
  EXPECT_TRUE(Load().ok());
}

TEST_F(TlsContextTest, NamesTheFileThatIsWrong) {
  files.key = folder / "absent.key";
  EXPECT_EQ(Load().code(), StatusCode::kNotFound);
  EXPECT_THAT(Load().where(), HasSubstr("absent.key"));
  files.key = folder / "a.crt";  // no key in it
  EXPECT_EQ(Load().code(), StatusCode::kParse);
  EXPECT_THAT(Load().what(), HasSubstr("private key"));
  files.key = folder / "a.key";
  files.certificate = folder / "a.key";
  EXPECT_THAT(Load().what(), HasSubstr("not a certificate"));
  files.certificate = folder / "a.crt";
  files.client_authority = folder / "a.key";
  EXPECT_THAT(Load().what(), HasSubstr("not a certificate"));
}

TEST_F(TlsContextTest, TheKeyMustBelongToTheCertificate) {
  Replace("a.key", TestCertificate().KeyText());
  EXPECT_EQ(Load().code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(Load().what(), HasSubstr("does not belong to the certificate"));
  EXPECT_EQ(ERR_peek_error(), 0u) << "later handshakes would report this error";
}

TEST_F(TlsContextTest, AKeyWithAPassphraseIsRefusedWithoutAsking) {
  Replace("a.key", certificate.KeyText("secret"));
  EXPECT_EQ(Load().code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(Load().what(), HasSubstr("the key has a passphrase"));
}

TEST_F(TlsContextTest, EveryTruncationOfTheFilesIsAnError) {
  const std::string whole = certificate.CertificateText();
  // The last line end may be absent.
  for (std::size_t size = 0; size + 2 < whole.size(); ++size) {
    Replace("a.crt", whole.substr(0, size));
    ASSERT_FALSE(Load().ok()) << size;
  }
  Replace("a.crt", whole);
  const std::string key = certificate.KeyText();
  for (std::size_t size = 0; size + 2 < key.size(); ++size) {
    Replace("a.key", key.substr(0, size));
    ASSERT_FALSE(Load().ok()) << size;
  }
}

TEST_F(TlsContextTest, WarnsAboutWhatClientsRefuse) {
  const auto warning = [&](const TestCertificate::Wanted& wanted) {
    TestCertificate(wanted).Write(folder.path(), "a");
    const auto contexts = LoadTlsContexts(files);
    return contexts.ok() ? contexts->warning : contexts.status().ToString();
  };
  EXPECT_THAT(warning({.from = -100, .until = -10}), HasSubstr("expired"));
  EXPECT_THAT(warning({.from = 1000, .until = 2000}), HasSubstr("not valid yet"));
  EXPECT_THAT(warning({.names = ""}), HasSubstr("subjectAltName"));
}

}  // namespace
}  // namespace furrow::server
