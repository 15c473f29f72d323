// SPDX-License-Identifier: Apache-2.0
#include "rig/shapes/shape_names.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "base/ascii.h"

namespace furrow::rig {
namespace {

bool IsDigit(char c) { return c >= '0' && c <= '9'; }
bool IsUpper(char c) { return c >= 'A' && c <= 'Z'; }
bool IsLower(char c) { return c >= 'a' && c <= 'z'; }
bool IsSeparator(char c) { return c == '_' || c == '-' || c == ' ' || c == '\t'; }

bool StartsWithPattern(std::string_view name, std::string_view pattern) {
  if (name.size() < pattern.size()) return false;
  return std::equal(pattern.begin(), pattern.end(), name.begin(), [](char wanted, char c) {
    return wanted == '#' ? IsDigit(c) : AsciiLower(wanted) == AsciiLower(c);
  });
}

// The position behind the last place in `name` that `mark` fits, without case.
std::optional<std::size_t> BehindLast(std::string_view name, std::string_view mark) {
  for (std::size_t at = name.size(); at-- > 0;) {
    if (StartsWithPattern(name.substr(at), mark)) return at + mark.size();
  }
  return std::nullopt;
}

// True if a new word starts at `at`: "browDown", "MTHAngry" and "AU6Left" have two words.
bool StartsWord(std::string_view text, std::size_t at) {
  if (at == 0) return true;
  const char before = text[at - 1];
  const char here = text[at];
  if (IsUpper(here)) {
    const bool before_lower = at + 1 < text.size() && IsLower(text[at + 1]);
    return !IsUpper(before) || before_lower;
  }
  return IsLower(here) && IsDigit(before);
}

std::vector<std::string> WordsOf(std::string_view core) {
  std::vector<std::string> words;
  bool is_new = true;
  for (std::size_t i = 0; i < core.size(); ++i) {
    if (IsSeparator(core[i])) {
      is_new = true;
      continue;
    }
    if (is_new || StartsWord(core, i)) words.emplace_back();
    is_new = false;
    words.back() += AsciiLower(core[i]);
  }
  return words;
}

// "au01" becomes "au1".
std::string WithoutLeadingZeros(const std::string& word) {
  std::string result;
  for (std::size_t i = 0; i < word.size(); ++i) {
    const bool starts_number = word[i] == '0' && (i == 0 || !IsDigit(word[i - 1]));
    if (!starts_number) {
      result += word[i];
      continue;
    }
    while (i + 1 < word.size() && word[i] == '0' && IsDigit(word[i + 1])) ++i;
    result += word[i];
  }
  return result;
}

}  // namespace

std::string_view ShapeNameCore(std::string_view name) {
  const std::size_t dot = name.rfind('.');
  if (dot != std::string_view::npos && dot > 0 && dot + 1 < name.size() &&
      std::all_of(name.begin() + static_cast<std::ptrdiff_t>(dot) + 1, name.end(), IsDigit)) {
    name = name.substr(0, dot);
  }
  const std::size_t mark = name.find_last_of(":|.");
  return mark == std::string_view::npos ? name : name.substr(mark + 1);
}

std::string_view WithoutShapePrefix(std::string_view core, std::span<const std::string> prefixes) {
  for (const std::string& prefix : prefixes) {
    std::size_t length = 0;
    if (prefix.starts_with('*')) {
      length = BehindLast(core, std::string_view(prefix).substr(1)).value_or(0);
    } else if (StartsWithPattern(core, prefix)) {
      length = prefix.size();
    }
    if (length > 0 && length < core.size()) return core.substr(length);
  }
  return core;
}

std::string NormalShapeName(std::string_view name, std::span<const std::string> prefixes) {
  std::vector<std::string> words = WordsOf(WithoutShapePrefix(ShapeNameCore(name), prefixes));
  std::vector<std::size_t> sides;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "l") words[i] = "left";
    if (words[i] == "r") words[i] = "right";
    if (words[i] == "left" || words[i] == "right") sides.push_back(i);
  }
  if (sides.size() == 1) {
    const auto side = words.begin() + static_cast<std::ptrdiff_t>(sides[0]);
    std::rotate(side, side + 1, words.end());
  }
  std::string normal;
  for (const std::string& word : words) normal += WithoutLeadingZeros(word);
  return normal;
}

}  // namespace furrow::rig
