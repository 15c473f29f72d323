// SPDX-License-Identifier: Apache-2.0
#include "protocol/messages/text.h"

#include <algorithm>
#include <cstdint>

namespace furrow::protocol {
namespace {

// Returns the size in bytes of the character that starts at `at`, or 0 if it is malformed.
std::size_t CharacterBytes(std::string_view text, std::size_t at) {
  const auto lead = static_cast<std::uint8_t>(text[at]);
  // Control characters would reach logs and terminals.
  if (lead < 0x80) return (lead < 0x20 || lead == 0x7F) ? 0 : 1;
  const std::size_t size = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  // 0x80 to 0xC1 never begin a character; above 0xF4, codes exceed U+10FFFF (RFC 3629).
  if (lead < 0xC2 || lead > 0xF4 || text.size() - at < size) return 0;
  std::uint32_t code = lead & (0x7Fu >> size);
  for (std::size_t i = 1; i < size; ++i) {
    const auto byte = static_cast<std::uint8_t>(text[at + i]);
    if ((byte & 0xC0) != 0x80) return 0;
    code = code << 6 | (byte & 0x3Fu);
  }
  // Overlong forms and surrogates are malformed: each character has one form.
  constexpr std::uint32_t kSmallest[] = {0, 0, 0x80, 0x800, 0x10000};
  if (code < kSmallest[size] || code > 0x10FFFF) return 0;
  return (code >= 0xD800 && code <= 0xDFFF) ? 0 : size;
}

}  // namespace

bool IsPlainText(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t size = CharacterBytes(text, at);
    if (size == 0) return false;
    at += size;
  }
  return true;
}

std::string_view PlainPrefix(std::string_view text, std::size_t max_bytes) {
  std::size_t end = std::min(text.size(), max_bytes);
  while (end > 0 && end < text.size() && (static_cast<std::uint8_t>(text[end]) & 0xC0) == 0x80) {
    --end;
  }
  return text.substr(0, end);
}

}  // namespace furrow::protocol
