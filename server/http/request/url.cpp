// SPDX-License-Identifier: Apache-2.0
#include "server/http/request/url.h"

#include <algorithm>
#include <utility>

#include "base/text.h"

namespace furrow::server {
namespace {

// In queries, a plus is a space.
std::optional<std::string> DecodeQuery(std::string_view text) {
  std::string spaced(text);
  std::ranges::replace(spaced, '+', ' ');
  return DecodePercent(spaced);
}

// Escapes all bytes except letters, digits and those that never mean anything (RFC 3986 section
// 2.3). `plain`: further bytes that stay.
std::string Escaped(std::string_view text, std::string_view plain = {}) {
  constexpr char kDigits[] = "0123456789ABCDEF";
  constexpr std::string_view kUnreserved =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._~";
  std::string escaped;
  for (const char c : text) {
    if (kUnreserved.find(c) != std::string_view::npos || plain.find(c) != std::string_view::npos) {
      escaped += c;
    } else {
      const auto byte = static_cast<unsigned char>(c);
      escaped += {'%', kDigits[byte / 16], kDigits[byte % 16]};
    }
  }
  return escaped;
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
  const auto path = DecodePercent(target.substr(0, question));
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
    const auto name = DecodeQuery(item.substr(0, equals));
    const auto value = equals == std::string_view::npos ? std::optional<std::string>("")
                                                        : DecodeQuery(item.substr(equals + 1));
    if (!name || !value) return std::nullopt;
    url.values.emplace_back(*name, *value);
  }
  return url;
}

std::string TargetOf(const Url& url) {
  std::string target = Escaped(url.path, "/");
  char separator = '?';
  for (const auto& [name, value] : url.values) {
    target += std::exchange(separator, '&') + Escaped(name) + '=' + Escaped(value);
  }
  return target;
}

}  // namespace furrow::server
