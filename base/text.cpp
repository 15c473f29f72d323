// SPDX-License-Identifier: Apache-2.0
#include "base/text.h"

#include <algorithm>
#include <vector>

#include "base/ascii.h"

namespace furrow {
namespace {

constexpr std::string_view kBlanks = " \t\v\f";

// The value of a hexadecimal digit; -1 for other characters.
int HexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// The insertions, deletions, replacements and exchanges of neighbours that make `b` of `a` (optimal
// string alignment).
std::size_t Differences(std::string_view a, std::string_view b) {
  const std::size_t width = b.size() + 1;
  std::vector<std::size_t> table((a.size() + 1) * width);
  const auto at = [&](std::size_t i, std::size_t j) -> std::size_t& {
    return table[i * width + j];
  };
  for (std::size_t i = 0; i <= a.size(); ++i) at(i, 0) = i;
  for (std::size_t j = 0; j <= b.size(); ++j) at(0, j) = j;
  const auto equal = [&](std::size_t i, std::size_t j) {
    return AsciiLower(a[i - 1]) == AsciiLower(b[j - 1]);
  };
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      at(i, j) =
          std::min({at(i - 1, j) + 1, at(i, j - 1) + 1, at(i - 1, j - 1) + (equal(i, j) ? 0 : 1)});
      if (i > 1 && j > 1 && equal(i, j - 1) && equal(i - 1, j)) {
        at(i, j) = std::min(at(i, j), at(i - 2, j - 2) + 1);
      }
    }
  }
  return table.back();
}

}  // namespace

std::string ClosestWord(std::string_view word, std::span<const std::string> known) {
  constexpr std::size_t kMostLetters = 64;  // longer words are not typing mistakes
  if (word.empty() || word.size() > kMostLetters) return {};
  const std::string* closest = nullptr;
  std::size_t least = word.size() / 3 + 1;
  for (const std::string& candidate : known) {
    if (candidate.size() > kMostLetters) continue;
    const std::size_t differences = Differences(word, candidate);
    if (differences < least) {
      least = differences;
      closest = &candidate;
    }
  }
  if (closest != nullptr) return *closest;
  const auto begun = std::ranges::find_if(known, [&](const std::string& candidate) {
    return EqualsIgnoreCase(std::string_view(candidate).substr(0, word.size()), word);
  });
  return begun == known.end() ? std::string() : *begun;
}

std::string DidYouMean(std::string_view word, std::span<const std::string> known,
                       std::string_view prefix) {
  const std::string meant = ClosestWord(word, known);
  return meant.empty() ? "" : "did you mean '" + std::string(prefix) + meant + "'?";
}

std::string UnknownWord(const std::string& kind, std::string_view word,
                        std::span<const std::string> known, const std::string& program) {
  const std::string meant = DidYouMean(word, known);
  return "unknown " + kind + " " + Quoted(word) + (meant.empty() ? "" : "; " + meant) + " ('" +
         program + " --help' lists the " + kind + "s)";
}

// For messages about hostile input: short, on one line, without control sequences for the terminal.
std::string Quoted(std::string_view text) {
  constexpr std::size_t kShown = 40;
  std::string quoted = "'";
  for (const char c : text.substr(0, kShown)) quoted += (c >= ' ' && c < 127) ? c : '?';
  return quoted + (text.size() > kShown ? "...'" : "'");
}

std::string ShellWord(std::string_view text) {
  constexpr std::string_view kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=:,./@%";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string_view::npos) {
    return std::string(text);
  }
  std::string word = "'";
  for (const char c : text) {
    if (c == '\'') {
      word += "'\\''";  // nothing escapes a quote within quotes
    } else {
      word += c;
    }
  }
  return word + "'";
}

std::string Where(std::string_view source, std::size_t line) {
  return std::string(source) + ":" + std::to_string(line);
}

std::size_t LineOf(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  return 1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
}

void SplitWords(std::string_view line, std::vector<std::string_view>* words) {
  words->clear();
  // '#' begins a comment.
  line = line.substr(0, line.find('#'));
  while (true) {
    const std::string_view word = TakeToken(&line);
    if (word.empty()) return;
    words->push_back(word);
  }
}

std::string_view TakeToken(std::string_view* line) {
  const std::size_t begin = std::min(line->find_first_not_of(kBlanks), line->size());
  const std::size_t end = std::min(line->find_first_of(kBlanks, begin), line->size());
  const std::string_view token = line->substr(begin, end - begin);
  line->remove_prefix(end);
  return token;
}

std::string CutText(const std::string& text, std::size_t most) {
  if (text.size() <= most) return text;
  while (most > 0 && (static_cast<unsigned char>(text[most]) & 0xC0) == 0x80) --most;
  return text.substr(0, most);
}

std::optional<std::string> DecodePercent(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i];
      continue;
    }
    const int high = i + 2 < text.size() ? HexDigit(text[i + 1]) : -1;
    const int low = high >= 0 ? HexDigit(text[i + 2]) : -1;
    if (low < 0) return std::nullopt;
    out += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return out;
}

std::string Counted(std::uint64_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many.empty() ? one + "s" : many);
}

}  // namespace furrow
