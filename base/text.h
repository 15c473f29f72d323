// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace furrow {

// A piece of a foreign file as a message shows it: in single quotes, at most 40 bytes, with '?' for
// every byte that is not printable ASCII.
[[nodiscard]] std::string Quoted(std::string_view text);

// A text as one word of a shell's command line, in single quotes unless that changes nothing.
[[nodiscard]] std::string ShellWord(std::string_view text);

// A UTF-8 text, cut to at most `most` bytes between two characters.
[[nodiscard]] std::string CutText(const std::string& text, std::size_t most);

// Replaces percent escapes: %2A stands for the byte with this hexadecimal number (RFC 3986 section
// 2.1). Returns nothing if two hexadecimal digits do not follow a '%'.
[[nodiscard]] std::optional<std::string> DecodePercent(std::string_view text);

// "1 pose", "2 poses", "0 poses". `many` is the plural if it is not `one` with an s.
[[nodiscard]] std::string Counted(std::uint64_t count, const std::string& one,
                                  const std::string& many = {});

// The word of `known` that was probably meant by `word`: at most a third of its letters differ, or
// it begins with `word`, whatever the case. Empty if there is none. Two letters that changed places
// count as one difference.
[[nodiscard]] std::string ClosestWord(std::string_view word, std::span<const std::string> known);
// "did you mean 'listen.tcp'?" for an unknown `word` if ClosestWord() finds one, else empty.
// `prefix`: stands before the word that was found, such as "listen.".
[[nodiscard]] std::string DidYouMean(std::string_view word, std::span<const std::string> known,
                                     std::string_view prefix = {});
// The message about an unknown word of a command line: "unknown option '--tpc'; did you mean
// '--tcp'? ('furrowd --help' lists the options)". `kind`: "option" or "command"; `program`: what
// takes --help.
[[nodiscard]] std::string UnknownWord(const std::string& kind, std::string_view word,
                                      std::span<const std::string> known,
                                      const std::string& program);

// Bytes seen as text; no copy is made.
[[nodiscard]] inline std::string_view AsText(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// The position in a text file as a Status states it: "source:line", lines counted from 1.
[[nodiscard]] std::string Where(std::string_view source, std::size_t line);

// The line, from 1, that holds byte `offset` of `text`.
[[nodiscard]] std::size_t LineOf(std::string_view text, std::size_t offset);

// Splits a line into words at blanks and tabs. A '#' starts a comment.
void SplitWords(std::string_view line, std::vector<std::string_view>* words);

// Removes the first blank-separated token of `line` and returns it; empty when there is none.
std::string_view TakeToken(std::string_view* line);

}  // namespace furrow
