// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "protocol/secure/token/connect_token.h"

namespace furrow::protocol::secure {

inline constexpr std::string_view kTokenPrefix = "frw1_";
// Of the text form: the prefix and 384 characters.
inline constexpr std::size_t kTokenTextBytes = 5 + 384;

// A token as text for files and addresses: the prefix and base64url of the token's bytes, its key
// and four bytes of BLAKE2b over both, which reveal a character that was lost while copying. The
// text is a secret: everybody who has it may use the token.
[[nodiscard]] std::string ToText(const ClientToken& token);

// Reads the text form; spaces and line ends around it are ignored. Errors (kParse) say what is
// wrong with it, without repeating it.
[[nodiscard]] Result<ClientToken> ParseToken(std::string_view text);

// Reads a file that holds one token in text form. Lines that begin with '#' are comments. Errors:
// as ParseToken() and ReadSecretFile().
[[nodiscard]] Result<ClientToken> LoadToken(const std::filesystem::path& path);

}  // namespace furrow::protocol::secure
