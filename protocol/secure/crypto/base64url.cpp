// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/crypto/base64url.h"

#include <sodium.h>

namespace furrow::protocol::secure {
namespace {
constexpr int kVariant = sodium_base64_VARIANT_URLSAFE_NO_PADDING;
}  // namespace

std::string ToBase64Url(ByteView bytes) {
  if (bytes.empty()) return {};  // libsodium accepts no null pointer
  std::string text(sodium_base64_ENCODED_LEN(bytes.size(), kVariant), '\0');
  sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(), kVariant);
  text.pop_back();  // libsodium writes a zero byte
  return text;
}

bool FromBase64Url(std::string_view text, ByteSpan bytes) {
  if (bytes.empty()) return text.empty();
  std::size_t size = 0;
  const char* end = nullptr;
  const int result = sodium_base642bin(bytes.data(), bytes.size(), text.data(), text.size(),
                                       nullptr, &size, &end, kVariant);
  return result == 0 && size == bytes.size() && end == text.data() + text.size();
}

}  // namespace furrow::protocol::secure
