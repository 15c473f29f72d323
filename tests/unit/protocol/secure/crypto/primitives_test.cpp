// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/crypto/primitives.h"

#include <cstring>
#include <new>
#include <string_view>

#include <gtest/gtest.h>

#include "protocol/secure/crypto/base64url.h"
#include "tests/unit/protocol/secure/secure_testing.h"

namespace furrow::protocol::secure {
namespace {

using test::FromHex;
using test::KeyFromHex;
using test::ToHex;

test::Bytes Text(std::string_view text) { return {text.begin(), text.end()}; }

// draft-irtf-cfrg-xchacha-03, appendix A.3.1.
TEST(Primitives, SealWithNonceIsXChaCha20Poly1305) {
  const Key key = KeyFromHex("808182838485868788898a8b8c8d8e8f909192939495969798999a9b9c9d9e9f");
  TokenNonce nonce;
  for (std::size_t i = 0; i < nonce.size(); ++i) nonce[i] = static_cast<std::uint8_t>(0x40 + i);
  const test::Bytes associated = FromHex("50515253c0c1c2c3c4c5c6c7");
  test::Bytes text = Text(
      "Ladies and Gentlemen of the class of '99: If I could offer you only one tip for the "
      "future, sunscreen would be it.");
  const test::Bytes plain = text;
  Mac tag;
  SealWithNonce(key, nonce, associated, text, tag);
  EXPECT_EQ(ToHex(std::span(text).first(16)), "bd6d179d3e83d43b9576579493c0e939");
  EXPECT_EQ(ToHex(tag), "c0875924c1c7987947deafd8780acf49");
  EXPECT_TRUE(OpenWithNonce(key, nonce, associated, text, tag));
  EXPECT_EQ(text, plain);
  tag[0] ^= 1;
  EXPECT_FALSE(OpenWithNonce(key, nonce, associated, text, tag));
  EXPECT_NE(text, plain);
}

// The expected values come from Python's hmac module.
TEST(Primitives, HkdfDependsOnKeyAndMaterial) {
  const Key chaining =
      KeyFromHex("000102030405060708090a0b0c0d0e0f101112131415161718191a1b1c1d1e1f");
  Key a;
  Key b;
  Key c;
  Hkdf3(chaining, Text("material"), a, b, c);
  EXPECT_EQ(ToHex(a), "ce6bfe8d7e55ee0616c37a5438406490108711e24f67b0be475b3a4fdaed7764");
  EXPECT_EQ(ToHex(b), "8f079697d3fa1b16722ebcda4a50701ba826b44e72962e7bb9312f838cfe983e");
  EXPECT_EQ(ToHex(c), "361cfd1d7d93bb80034077e100811e9049e60c0f08605ab3c2ad1ab2cc58c174");
  Key in_place = chaining;
  Key second;
  Hkdf2(in_place, Text("material"), in_place, second);
  EXPECT_EQ(ToHex(in_place), ToHex(a));
  EXPECT_EQ(ToHex(second), ToHex(b));
}

// The values of BLAKE2b come from Python's hashlib.
TEST(Primitives, Hashes) {
  EXPECT_EQ(ToHex(Sha256(Text("abc"))),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(Sha256(Text("a"), Text("b"), Text("c")), Sha256(Text("abc")));
  EXPECT_EQ(ToHex(Blake2b128(Text("abc"))), "cf4ab791c62b8d2b2109c90275287816");
  EXPECT_EQ(ToHex(Blake2b128(KeyFromHex(std::string(64, '1')), Text("abc"))),
            "d72d466cbf1b7971d9a8c64c6d2e3f17");
}

// The public vectors of the handshake check the values.
TEST(Primitives, X25519Agrees) {
  test::RepeatableRandom random;
  const KeyPair one = MakeKeyPair(random);
  const KeyPair two = MakeKeyPair(random);
  Key a;
  Key b;
  ASSERT_TRUE(X25519(one.secret, two.shared, a));
  ASSERT_TRUE(X25519(two.secret, one.shared, b));
  EXPECT_TRUE(EqualInConstantTime(a.bytes(), b.bytes()));
}

// With a point of low order, the result would be zero whatever the secret is.
TEST(Primitives, X25519RefusesPointsOfLowOrder) {
  test::RepeatableRandom random;
  const KeyPair pair = MakeKeyPair(random);
  Key result;
  for (const char* point : {"0000000000000000000000000000000000000000000000000000000000000000",
                            "0100000000000000000000000000000000000000000000000000000000000000",
                            "e0eb7a7c3b41b8ae1656e3faf19fc46ada098deb9c32b1fd866205165f49b800",
                            "5f9c95bca3508c24b1d0b1559c83ef5b04445cc4581c8e86d8224eddd09f1157",
                            "ecffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff7f"}) {
    PublicKey low;
    const test::Bytes bytes = FromHex(point);
    std::copy(bytes.begin(), bytes.end(), low.begin());
    EXPECT_FALSE(X25519(pair.secret, low, result)) << point;
  }
}

TEST(Primitives, ComparesSizesToo) {
  const test::Bytes a = {1, 2, 3};
  EXPECT_TRUE(EqualInConstantTime(a, a));
  EXPECT_FALSE(EqualInConstantTime(a, std::span(a).first(2)));
  EXPECT_FALSE(EqualInConstantTime(a, test::Bytes{1, 2, 4}));
}

TEST(Secret, IsWipedWhenItEnds) {
  alignas(Key) std::uint8_t storage[sizeof(Key)];
  auto* const key = new (storage) Key(KeyFromHex(std::string(64, 'a')));
  key->~Key();
  // Reads storage that this test owns.
  volatile std::uint8_t all = 0;
  for (const std::uint8_t byte : storage) all = all | byte;
  EXPECT_EQ(all, 0);
}

TEST(RandomSource, TheSystemsDiffers) {
  EXPECT_NE(ToHex(SystemRandom().MakeKey()), ToHex(SystemRandom().MakeKey()));
}

TEST(Base64Url, RoundTripsAndRejectsOtherForms) {
  for (const std::string_view text : {"", "f", "fo", "foo", "foob", "fooba", "foobar"}) {
    const test::Bytes bytes = Text(text);
    test::Bytes again(bytes.size());
    EXPECT_TRUE(FromBase64Url(ToBase64Url(bytes), again));
    EXPECT_EQ(again, bytes);
  }
  EXPECT_EQ(ToBase64Url(FromHex("fbff")), "-_8");
  test::Bytes two(2);
  EXPECT_TRUE(FromBase64Url("-_8", two));
  for (const std::string_view bad :
       {"-_9", "+/8", "-_8=", "-_", "-_8A", "-_8 ", " -_8", "", "-!8"}) {
    EXPECT_FALSE(FromBase64Url(bad, two)) << bad;
  }
}

}  // namespace
}  // namespace furrow::protocol::secure
