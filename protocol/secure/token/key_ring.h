// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "protocol/secure/crypto/primitives.h"

namespace furrow::protocol::secure {

// A key that seals connect tokens. Issuers and servers share it.
struct TokenKey {
  std::uint32_t id = 0;
  std::uint64_t created = 0;  // Unix time in seconds
  std::uint64_t expires = 0;  // its tokens are valid before this time
  Key key;
};

// The keys of an issuer or a server: at most kMaxKeys, with different ids. New tokens use the
// newest key; older keys stay until their tokens have expired, so keys change without a gap.
class KeyRing {
 public:
  static constexpr std::size_t kMaxKeys = 64;

  [[nodiscard]] const std::vector<TokenKey>& keys() const { return keys_; }

  // The key with this id, or null. Servers call it for every initiation, so it reads no secret.
  [[nodiscard]] const TokenKey* Find(std::uint32_t id) const;
  // The key for new tokens: of those valid at `now` (Unix time in seconds), the newest; or null.
  [[nodiscard]] const TokenKey* Newest(std::uint64_t now) const;

  // Adds a key with a random id that is not taken. Error: kLimit.
  [[nodiscard]] Result<std::uint32_t> AddNew(std::uint64_t now, std::uint64_t expires,
                                             RandomSource& random);
  // Removes a key. Its tokens are invalid for every server that reads the ring again. False if
  // there is no such key.
  bool Remove(std::uint32_t id);

  // The text of a key file (docs/TOKENS.md).
  [[nodiscard]] std::string ToText() const;
  // Reads it. Errors (kParse, kLimit), with "source:line" as `where`.
  [[nodiscard]] static Result<KeyRing> Parse(std::string_view text, std::string_view source);

 private:
  std::vector<TokenKey> keys_;  // in the order of the file
};

// "7f3a0c21": eight hexadecimal digits.
[[nodiscard]] std::string KeyIdText(std::uint32_t id);
// Reads 1 to 8 hexadecimal digits. False for other text.
[[nodiscard]] bool ParseKeyId(std::string_view text, std::uint32_t& id);

// Reads and writes key files. Errors: as ReadSecretFile(), WriteSecretFile() and Parse().
[[nodiscard]] Result<KeyRing> LoadKeyRing(const std::filesystem::path& path);
[[nodiscard]] Status SaveKeyRing(const KeyRing& ring, const std::filesystem::path& path);

}  // namespace furrow::protocol::secure
