// SPDX-License-Identifier: Apache-2.0
#include "protocol/messages/pattern.h"

#include <cstddef>

namespace furrow::protocol {
namespace {

// On a mismatch, only the last `*` is extended by one character. Extending an earlier `*` never
// finds a match that the last one misses, so there is no need for recursion.
bool MatchesGlob(std::string_view glob, std::string_view name) {
  std::size_t g = 0;
  std::size_t n = 0;
  std::size_t star = std::string_view::npos;
  std::size_t star_name = 0;
  while (n < name.size()) {
    if (g < glob.size() && glob[g] == '*') {
      star = g++;
      star_name = n;
    } else if (g < glob.size() && (glob[g] == '?' || glob[g] == name[n])) {
      ++g;
      ++n;
    } else if (star != std::string_view::npos) {
      g = star + 1;
      n = ++star_name;
    } else {
      return false;
    }
  }
  while (g < glob.size() && glob[g] == '*') ++g;
  return g == glob.size();
}

std::string_view Trim(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

}  // namespace

std::string_view NextGlob(std::string_view* pattern) {
  const std::size_t comma = pattern->find(',');
  const std::string_view glob = Trim(pattern->substr(0, comma));
  *pattern = comma == std::string_view::npos ? std::string_view() : pattern->substr(comma + 1);
  return glob;
}

bool MatchesPattern(std::string_view pattern, std::string_view name) {
  while (!pattern.empty()) {
    const std::string_view glob = NextGlob(&pattern);
    if (!glob.empty() && MatchesGlob(glob, name)) return true;
  }
  return false;
}

}  // namespace furrow::protocol
