// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

namespace furrow {

// A certificate with its key, made by the test, so that it never expires in the repository.
class TestCertificate {
 public:
  static constexpr long kDay = 86'400;  // seconds
  struct Wanted {
    std::string names = "DNS:localhost,IP:127.0.0.1";  // subjectAltName; empty: none
    long from = -kDay;                                 // seconds from now
    long until = kDay;
    bool is_authority = false;
  };

  // Signs itself.
  TestCertificate() : TestCertificate(Wanted{}, nullptr) {}
  explicit TestCertificate(const Wanted& wanted) : TestCertificate(wanted, nullptr) {}
  // `issuer`: signs the certificate; null: it signs itself.
  TestCertificate(const Wanted& wanted, const TestCertificate* issuer)
      : key_(EVP_EC_gen("P-256")), certificate_(X509_new()) {
    static long serial = 0;
    X509_set_version(certificate_.get(), 2);  // counted from 0
    ASN1_INTEGER_set(X509_get_serialNumber(certificate_.get()), ++serial);
    X509_gmtime_adj(X509_getm_notBefore(certificate_.get()), wanted.from);
    X509_gmtime_adj(X509_getm_notAfter(certificate_.get()), wanted.until);
    X509_set_pubkey(certificate_.get(), key_.get());
    const std::string name = "furrow test " + std::to_string(serial);
    X509_NAME* const subject = X509_get_subject_name(certificate_.get());
    X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_ASC,
                               reinterpret_cast<const unsigned char*>(name.c_str()), -1, -1, 0);
    const TestCertificate& signer = issuer != nullptr ? *issuer : *this;
    X509_set_issuer_name(certificate_.get(), X509_get_subject_name(signer.certificate_.get()));
    if (!wanted.names.empty()) AddExtension(NID_subject_alt_name, wanted.names);
    if (wanted.is_authority) AddExtension(NID_basic_constraints, "critical,CA:TRUE");
    EXPECT_GT(X509_sign(certificate_.get(), signer.key_.get(), EVP_sha256()), 0);
  }

  [[nodiscard]] std::string CertificateText() const {
    return Text([&](BIO* bio) { return PEM_write_bio_X509(bio, certificate_.get()); });
  }
  // `passphrase`: encrypts the key; empty: it is not encrypted.
  [[nodiscard]] std::string KeyText(const std::string& passphrase = {}) const {
    return Text([&](BIO* bio) {
      const EVP_CIPHER* const cipher = passphrase.empty() ? nullptr : EVP_aes_128_cbc();
      return PEM_write_bio_PrivateKey(bio, key_.get(), cipher,
                                      reinterpret_cast<const unsigned char*>(passphrase.data()),
                                      static_cast<int>(passphrase.size()), nullptr, nullptr);
    });
  }
  // Writes NAME.crt and NAME.key into the folder. Returns the first of them.
  std::filesystem::path Write(const std::filesystem::path& folder, const std::string& name) const {
    std::ofstream(folder / (name + ".crt")) << CertificateText();
    std::ofstream(folder / (name + ".key")) << KeyText();
    return folder / (name + ".crt");
  }

 private:
  struct Free {
    void operator()(EVP_PKEY* key) const { EVP_PKEY_free(key); }
    void operator()(X509* certificate) const { X509_free(certificate); }
    void operator()(X509_EXTENSION* extension) const { X509_EXTENSION_free(extension); }
    void operator()(BIO* bio) const { BIO_free(bio); }
  };

  void AddExtension(int kind, const std::string& value) {
    const std::unique_ptr<X509_EXTENSION, Free> extension(
        X509V3_EXT_conf_nid(nullptr, nullptr, kind, value.c_str()));
    EXPECT_EQ(X509_add_ext(certificate_.get(), extension.get(), -1), 1) << value;
  }
  template <class Write>
  static std::string Text(Write write) {
    const std::unique_ptr<BIO, Free> bio(BIO_new(BIO_s_mem()));
    EXPECT_EQ(write(bio.get()), 1);
    char* text = nullptr;
    const long size = BIO_get_mem_data(bio.get(), &text);
    return {text, static_cast<std::size_t>(size)};
  }

  std::unique_ptr<EVP_PKEY, Free> key_;
  std::unique_ptr<X509, Free> certificate_;
};

}  // namespace furrow
