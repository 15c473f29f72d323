// SPDX-License-Identifier: Apache-2.0
#include "server/http/request/url.h"

namespace furrow::server {
namespace {

// The value of a hexadecimal digit; -1 for other characters.
int HexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// Decodes percent escapes; nullopt if one is cut or invalid. A plus is a space in queries only.
std::optional<std::string> Decode(std::string_view text, bool plus_is_space) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '+' && plus_is_space) {
      out += ' ';
    } else if (text[i] != '%') {
      out += text[i];
    } else {
      const int high = i + 2 < text.size() ? HexDigit(text[i + 1]) : -1;
      const int low = high >= 0 ? HexDigit(text[i + 2]) : -1;
      if (low < 0) return std::nullopt;
      out += static_cast<char>(high * 16 + low);
      i += 2;
    }
  }
  return out;
}

}  // namespace

std::string_view Url::Value(std::string_view name) const {
  // From the back: the last of several equal names wins.
  for (auto entry = values.rbegin(); entry != values.rend(); ++entry) {
    if (entry->first == name) return entry->second;
  }
  return {};
}

std::optional<Url> ParseUrl(std::string_view target) {
  if (!target.starts_with('/')) return std::nullopt;
  // Browsers do not send a fragment; other clients may.
  target = target.substr(0, target.find('#'));
  const std::size_t question = target.find('?');
  // Decoded once. Later code sees only the decoded path, so an escaped character cannot pass a
  // check and then change its meaning.
  const auto path = Decode(target.substr(0, question), false);
  if (!path) return std::nullopt;
  Url url{*path, {}};
  if (question == std::string_view::npos) return url;
  std::string_view query = target.substr(question + 1);
  // The header limit bounds the number of values.
  while (!query.empty()) {
    const std::size_t end = query.find('&');
    const std::string_view item = query.substr(0, end);
    query = end == std::string_view::npos ? std::string_view() : query.substr(end + 1);
    if (item.empty()) continue;
    const std::size_t equals = item.find('=');
    const auto name = Decode(item.substr(0, equals), true);
    const auto value = equals == std::string_view::npos ? std::optional<std::string>("")
                                                        : Decode(item.substr(equals + 1), true);
    if (!name || !value) return std::nullopt;
    url.values.emplace_back(*name, *value);
  }
  return url;
}

}  // namespace furrow::server
