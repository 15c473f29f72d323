// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "protocol/secure/crypto/primitives.h"
#include "protocol/secure/token/roles.h"

// Connect tokens (STANDARD.md section 14): what a client shows to a server to be let in.
namespace furrow::protocol::secure {

inline constexpr std::size_t kTokenPublicBytes = 44;
inline constexpr std::size_t kTokenPrivateBytes = 192;
inline constexpr std::size_t kTokenBytes = kTokenPublicBytes + kTokenPrivateBytes + kTagBytes;
static_assert(kTokenBytes == 252);
inline constexpr std::size_t kMaxAudienceBytes = 47;
inline constexpr std::size_t kMaxSubjectsBytes = 95;

// A token as it travels.
using TokenBytes = std::array<std::uint8_t, kTokenBytes>;
using TokenView = std::span<const std::uint8_t, kTokenBytes>;

// The part that everybody can read.
struct TokenHead {
  std::uint32_t key_id = 0;
  std::uint64_t expires = 0;  // Unix time in seconds; the token is valid before it
  TokenNonce nonce{};
};

// The permissions of a token's holder. Sealed in the token, so only servers can read them.
struct Grant {
  std::uint64_t client_id = 0;  // who this is, chosen by the issuer
  Roles roles;
  std::uint32_t packets_per_second = 0;  // 0: the limit of the server
  std::string subjects = "*";  // globs (pattern.h) of the subjects; 1 to kMaxSubjectsBytes
  std::string audience;        // the name of the only server that accepts it; empty: any server

  [[nodiscard]] bool MayPublish(std::string_view subject) const;
  [[nodiscard]] bool MayWatch(std::string_view subject) const;
};

// A token for its holder: the bytes to show, and the key that only the holder and servers know. The
// key never travels; it is the pre-shared key of the handshake.
struct ClientToken {
  TokenBytes bytes{};
  Key key;
};

// A token that a server has opened.
struct OpenedToken {
  Grant grant;
  Key key;
};

enum class TokenStatus : std::uint8_t {
  kOk = 0,
  kBadMagic,      // not a token
  kBadVersion,    // of a version that this build does not know
  kBadReserved,   // a reserved byte that is not 0
  kNotAuthentic,  // sealed with another key, or changed
  kBadRoles,      // no role, or an undefined one
  kBadSubjects,   // an empty or malformed pattern
  kBadAudience,   // malformed text
};
// A phrase for logs and messages: "sealed with another key, or changed".
[[nodiscard]] const char* TokenStatusText(TokenStatus status);

// Reads the public part and checks magic, version and reserved bytes. Nothing in it is proven.
[[nodiscard]] TokenStatus ReadTokenHead(TokenView token, TokenHead& head);
// Checks the seal with the key that the head names, and reads the private part.
[[nodiscard]] TokenStatus OpenToken(TokenView token, const Key& token_key, OpenedToken& opened);

// Makes a token with a fresh key and nonce. Errors (kInvalidArgument): a grant without roles, or
// with a pattern or an audience that is empty where it must not be, too long, or not plain text.
[[nodiscard]] Result<ClientToken> MakeToken(std::uint32_t key_id, const Key& token_key,
                                            std::uint64_t expires, const Grant& grant,
                                            RandomSource& random);

}  // namespace furrow::protocol::secure
