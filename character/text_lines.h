// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "wrinkle/status.h"

namespace furrow::character {

// The whole of a text file. Errors: kNotFound, kIo, kLimit (more than 256 MiB), with the path.
[[nodiscard]] Result<std::string> ReadTextFile(const std::filesystem::path& path);

// Walks a text line by line and counts; ends of line are LF or CRLF.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : rest_(text) {}

  [[nodiscard]] bool Next(std::string_view* line);
  [[nodiscard]] int line_number() const { return line_number_; }  // of the last line, from 1

 private:
  std::string_view rest_;
  int line_number_ = 0;
};

// The words of a line, parted by blanks and tabs, without what follows a '#'.
void SplitWords(std::string_view line, std::vector<std::string_view>* words);

// A whole word as a number, independent of the locale; nullopt when it is anything else. Infinities
// and NaNs are numbers here: the caller says kNonFinite.
[[nodiscard]] std::optional<float> ToFloat(std::string_view word);
[[nodiscard]] std::optional<long> ToInteger(std::string_view word);

// "source:line".
[[nodiscard]] std::string Where(std::string_view source, int line);
// A word fit for a message: cut after 40 bytes, without control characters.
[[nodiscard]] std::string Quoted(std::string_view word);

}  // namespace furrow::character
