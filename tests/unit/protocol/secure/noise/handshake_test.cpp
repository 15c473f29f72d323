// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/noise/handshake.h"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "protocol/secure/noise/cipher_state.h"
#include "tests/unit/protocol/secure/secure_testing.h"

namespace furrow::protocol::secure {
namespace {

using test::Bytes;
using test::FromHex;
using test::KeyFromHex;
using test::ToHex;

// Gives the bytes of a vector instead of random ones.
class FixedRandom : public RandomSource {
 public:
  explicit FixedRandom(Bytes bytes) : bytes_(std::move(bytes)) {}
  void Fill(ByteSpan bytes) override {
    ASSERT_LE(bytes.size(), bytes_.size());
    std::copy_n(bytes_.begin(), bytes.size(), bytes.begin());
    bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(bytes.size()));
  }

 private:
  Bytes bytes_;
};

// The hexadecimal values of a field of the vector, in the order of the file. Enough of JSON for a
// file that the test owns.
std::vector<std::string> Field(const std::string& text, const std::string& name) {
  std::vector<std::string> values;
  std::size_t at = 0;
  while ((at = text.find("\"" + name + "\"", at)) != std::string::npos) {
    at = text.find('"', text.find(':', at)) + 1;
    values.push_back(text.substr(at, text.find('"', at) - at));
  }
  return values;
}

struct Vector {
  Vector() {
    std::ifstream in(FURROW_SOURCE_DIR "/protocol/vectors/secure/noise_nnpsk0.json");
    std::stringstream all;
    all << in.rdbuf();
    const std::string text = all.str();
    psk = Field(text, "init_psks").at(0);
    prologue = FromHex(Field(text, "init_prologue").at(0));
    initiator = FromHex(Field(text, "init_ephemeral").at(0));
    responder = FromHex(Field(text, "resp_ephemeral").at(0));
    hash = Field(text, "handshake_hash").at(0);
    for (const auto& payload : Field(text, "payload")) payloads.push_back(FromHex(payload));
    for (const auto& c : Field(text, "ciphertext")) ciphertexts.push_back(FromHex(c));
  }
  std::string psk;
  Bytes prologue, initiator, responder;
  std::string hash;
  std::vector<Bytes> payloads, ciphertexts;
};

// The two sides of a handshake.
struct Pair {
  explicit Pair(const Key& psk, ByteView prologue, Bytes a, Bytes b)
      : random_a(std::move(a)),
        random_b(std::move(b)),
        initiator(Handshake::Side::kInitiator, psk, prologue, random_a),
        responder(Handshake::Side::kResponder, psk, prologue, random_b) {}
  FixedRandom random_a, random_b;
  Handshake initiator, responder;
};

TEST(Handshake, ReproducesThePublicVector) {
  const Vector v;
  ASSERT_EQ(v.payloads.size(), 6u);
  Pair pair(KeyFromHex(v.psk), v.prologue, v.initiator, v.responder);
  Bytes first(v.ciphertexts[0].size());
  ASSERT_EQ(pair.initiator.Write(v.payloads[0], first), HandshakeStatus::kOk);
  EXPECT_EQ(ToHex(first), ToHex(v.ciphertexts[0]));
  Bytes payload(v.payloads[0].size());
  ASSERT_EQ(pair.responder.Read(first, payload), HandshakeStatus::kOk);
  EXPECT_EQ(payload, v.payloads[0]);

  Bytes second(v.ciphertexts[1].size());
  ASSERT_EQ(pair.responder.Write(v.payloads[1], second), HandshakeStatus::kOk);
  EXPECT_EQ(ToHex(second), ToHex(v.ciphertexts[1]));
  payload.resize(v.payloads[1].size());
  ASSERT_EQ(pair.initiator.Read(second, payload), HandshakeStatus::kOk);
  EXPECT_EQ(payload, v.payloads[1]);

  ASSERT_TRUE(pair.initiator.done() && pair.responder.done());
  const SessionKeys a = pair.initiator.Split();
  const SessionKeys b = pair.responder.Split();
  EXPECT_EQ(ToHex(a.handshake_hash), v.hash);
  EXPECT_EQ(ToHex(b.handshake_hash), v.hash);
  EXPECT_EQ(ToHex(a.send), ToHex(b.receive));
  EXPECT_EQ(ToHex(a.receive), ToHex(b.send));
  // The transport messages of the vector: initiator and responder take turns.
  CipherState forward(a.send);
  CipherState back(a.receive);
  for (std::size_t i = 2; i < v.payloads.size(); ++i) {
    Bytes text = v.payloads[i];
    Mac tag;
    (i % 2 == 0 ? forward : back).Encrypt({}, text, tag);
    text.insert(text.end(), tag.begin(), tag.end());
    EXPECT_EQ(ToHex(text), ToHex(v.ciphertexts[i])) << i;
  }
}

TEST(Handshake, RefusesEveryFlippedBit) {
  const Vector v;
  for (int message = 0; message < 2; ++message) {
    for (std::size_t bit = 0; bit < v.ciphertexts[0].size() * 8; ++bit) {
      Pair pair(KeyFromHex(v.psk), v.prologue, v.initiator, v.responder);
      Bytes bytes(v.ciphertexts[0].size());
      Bytes payload(v.payloads[0].size());
      ASSERT_EQ(pair.initiator.Write(v.payloads[0], bytes), HandshakeStatus::kOk);
      Handshake* reader = &pair.responder;
      if (message == 1) {
        ASSERT_EQ(pair.responder.Read(bytes, payload), HandshakeStatus::kOk);
        ASSERT_EQ(pair.responder.Write(v.payloads[0], bytes), HandshakeStatus::kOk);
        reader = &pair.initiator;
      }
      bytes[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
      // X25519 ignores the highest bit of a public key; the hash of the handshake does not.
      ASSERT_NE(reader->Read(bytes, payload), HandshakeStatus::kOk) << message << " " << bit;
      ASSERT_NE(payload, v.payloads[0]);
      // The same handshake accepts the good message afterwards.
      bytes[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
      ASSERT_EQ(reader->Read(bytes, payload), HandshakeStatus::kOk);
    }
  }
}

TEST(Handshake, NeedsTheSameKeyAndPrologue) {
  test::RepeatableRandom random;
  const Key key = random.MakeKey();
  const Bytes prologue = {1, 2, 3};
  Handshake initiator(Handshake::Side::kInitiator, key, prologue, random);
  Bytes message(kHandshakeOverheadBytes);
  ASSERT_EQ(initiator.Write({}, message), HandshakeStatus::kOk);
  Handshake other_key(Handshake::Side::kResponder, random.MakeKey(), prologue, random);
  EXPECT_EQ(other_key.Read(message, {}), HandshakeStatus::kNotAuthentic);
  Handshake other_prologue(Handshake::Side::kResponder, key, Bytes{1, 2}, random);
  EXPECT_EQ(other_prologue.Read(message, {}), HandshakeStatus::kNotAuthentic);
  Handshake good(Handshake::Side::kResponder, key, prologue, random);
  EXPECT_EQ(good.Read(message, {}), HandshakeStatus::kOk);
}

TEST(Handshake, KeepsTheOrderAndTheSizes) {
  test::RepeatableRandom random;
  const Key key = random.MakeKey();
  Handshake initiator(Handshake::Side::kInitiator, key, {}, random);
  Handshake responder(Handshake::Side::kResponder, key, {}, random);
  Bytes message(kHandshakeOverheadBytes + 4);
  Bytes payload(4);
  EXPECT_EQ(initiator.Read(message, payload), HandshakeStatus::kOutOfTurn);
  EXPECT_EQ(responder.Write(payload, message), HandshakeStatus::kOutOfTurn);
  EXPECT_EQ(initiator.Write(payload, ByteSpan(message).first(51)), HandshakeStatus::kBadSize);
  ASSERT_EQ(initiator.Write(payload, message), HandshakeStatus::kOk);
  EXPECT_EQ(initiator.Write(payload, message), HandshakeStatus::kOutOfTurn);
  for (std::size_t size = 0; size < message.size(); ++size) {
    EXPECT_EQ(responder.Read(ByteView(message).first(size), payload), HandshakeStatus::kBadSize);
  }
  ASSERT_EQ(responder.Read(message, payload), HandshakeStatus::kOk);
  EXPECT_EQ(responder.Read(message, payload), HandshakeStatus::kOutOfTurn);
  ASSERT_EQ(responder.Write(payload, message), HandshakeStatus::kOk);
  ASSERT_EQ(initiator.Read(message, payload), HandshakeStatus::kOk);
  EXPECT_EQ(initiator.Write(payload, message), HandshakeStatus::kOutOfTurn);
}

// A point of low order would let an attacker know the shared secret of X25519.
TEST(Handshake, RefusesPointsOfLowOrder) {
  test::RepeatableRandom random;
  const Key key = random.MakeKey();
  Handshake initiator(Handshake::Side::kInitiator, key, {}, random);
  Bytes message(kHandshakeOverheadBytes);
  ASSERT_EQ(initiator.Write({}, message), HandshakeStatus::kOk);
  const Bytes low(kHandshakeOverheadBytes);
  EXPECT_EQ(initiator.Read(low, {}), HandshakeStatus::kBadPoint);
  // A client that knows the key of its token can send one to the server.
  SymmetricState state(
      ByteView(reinterpret_cast<const std::uint8_t*>("Noise_NNpsk0_25519_ChaChaPoly_SHA256"), 36));
  state.MixHash({});
  state.MixKeyAndHash(key.bytes());
  const PublicKey zero{};
  state.MixHash(zero);
  state.MixKey(zero);
  Bytes forged(kHandshakeOverheadBytes);
  state.EncryptAndHash({}, ByteSpan(forged).last<kTagBytes>());
  Handshake responder(Handshake::Side::kResponder, key, {}, random);
  ASSERT_EQ(responder.Read(forged, {}), HandshakeStatus::kOk);
  EXPECT_EQ(responder.Write({}, message), HandshakeStatus::kBadPoint);
}

// A server that restarts, or a client that repeats its first message, never gets old keys again.
TEST(Handshake, KeysDifferEvenIfOneSideRepeatsItself) {
  const Vector v;
  test::RepeatableRandom random;
  std::vector<std::string> keys;
  for (int i = 0; i < 8; ++i) {
    FixedRandom same(v.initiator);
    Handshake initiator(Handshake::Side::kInitiator, KeyFromHex(v.psk), {}, same);
    Handshake responder(Handshake::Side::kResponder, KeyFromHex(v.psk), {}, random);
    Bytes message(kHandshakeOverheadBytes);
    ASSERT_EQ(initiator.Write({}, message), HandshakeStatus::kOk);
    ASSERT_EQ(responder.Read(message, {}), HandshakeStatus::kOk);
    ASSERT_EQ(responder.Write({}, message), HandshakeStatus::kOk);
    const SessionKeys split = responder.Split();
    keys.push_back(ToHex(split.send));
    keys.push_back(ToHex(split.receive));
  }
  std::sort(keys.begin(), keys.end());
  EXPECT_EQ(std::adjacent_find(keys.begin(), keys.end()), keys.end());
}

TEST(CipherState, RekeyIsOneWayAndKeepsTheNonce) {
  test::RepeatableRandom random;
  const Key key = random.MakeKey();
  // Noise, section 4.2, by hand: the first 32 bytes of ENCRYPT(k, 2^64-1, "", 32 zeros).
  Key expected;
  Mac tag;
  Seal(key, ~std::uint64_t{0}, {}, expected.bytes(), tag);
  EXPECT_EQ(ToHex(NextKey(key)), ToHex(expected));
  CipherState sender(key);
  CipherState receiver(key);
  Bytes text = {1, 2, 3};
  sender.Encrypt({}, text, tag);
  ASSERT_TRUE(receiver.Decrypt({}, text, tag));
  sender.Rekey();
  sender.Encrypt({}, text, tag);
  Bytes copy = text;
  EXPECT_FALSE(receiver.Decrypt({}, copy, tag));
  receiver.Rekey();
  EXPECT_TRUE(receiver.Decrypt({}, text, tag));
}

}  // namespace
}  // namespace furrow::protocol::secure
