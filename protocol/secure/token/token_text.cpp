// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/token/token_text.h"

#include <algorithm>

#include "base/files.h"
#include "protocol/secure/crypto/base64url.h"

namespace furrow::protocol::secure {
namespace {

constexpr std::size_t kCheckBytes = 4;
constexpr std::size_t kTextContentBytes = kTokenBytes + kKeyBytes + kCheckBytes;
static_assert(kTextContentBytes == 288);
constexpr std::uint64_t kMaxTokenFileBytes = 16 * 1024;

using Content = Secret<kTextContentBytes>;

// The first bytes of a hash over token and key.
Mac CheckOf(const Content& content) {
  return Blake2b128(content.bytes().first<kTokenBytes + kKeyBytes>());
}

std::string_view Trim(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

}  // namespace

std::string ToText(const ClientToken& token) {
  Content content;
  const auto bytes = content.bytes();
  std::copy(token.bytes.begin(), token.bytes.end(), bytes.begin());
  std::copy_n(token.key.bytes().begin(), kKeyBytes, bytes.begin() + kTokenBytes);
  std::copy_n(CheckOf(content).begin(), kCheckBytes, bytes.end() - kCheckBytes);
  return std::string(kTokenPrefix) + ToBase64Url(bytes);
}

Result<ClientToken> ParseToken(std::string_view text) {
  text = Trim(text);
  if (!text.starts_with(kTokenPrefix)) {
    return Status(StatusCode::kParse, "a token begins with '" + std::string(kTokenPrefix) + "'", "",
                  "make one with 'furrow token new'");
  }
  if (text.size() != kTokenTextBytes) {
    return Status(StatusCode::kParse,
                  "the token has " + std::to_string(text.size()) + " characters instead of " +
                      std::to_string(kTokenTextBytes),
                  "", "copy it again, in one piece");
  }
  Content content;
  const auto bytes = content.bytes();
  const bool decoded = FromBase64Url(text.substr(kTokenPrefix.size()), bytes);
  if (!decoded || !EqualInConstantTime(ByteView(CheckOf(content)).first<kCheckBytes>(),
                                       bytes.last<kCheckBytes>())) {
    return Status(StatusCode::kParse, "the token was changed: its checksum does not match", "",
                  "copy it again, in one piece");
  }
  ClientToken token;
  std::copy_n(bytes.begin(), kTokenBytes, token.bytes.begin());
  token.key = Key(bytes.subspan<kTokenBytes, kKeyBytes>());
  TokenHead head;
  if (const TokenStatus status = ReadTokenHead(token.bytes, head); status != TokenStatus::kOk) {
    return Status(StatusCode::kParse, TokenStatusText(status));
  }
  return token;
}

Result<ClientToken> LoadToken(const std::filesystem::path& path) {
  auto content = ReadSecretFile(path, kMaxTokenFileBytes);
  FURROW_RETURN_IF_ERROR(content);
  std::string_view rest = *content;
  while (Trim(rest).starts_with('#')) {
    rest = Trim(rest);
    rest.remove_prefix(std::min(rest.find('\n'), rest.size()));
  }
  auto token = ParseToken(rest);
  Wipe({reinterpret_cast<std::uint8_t*>(content->data()), content->size()});
  return token.ok() ? std::move(token) : Result<ClientToken>(token.status().At(path.string()));
}

}  // namespace furrow::protocol::secure
