// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "base/status.h"

namespace furrow {

// Walks a text by tokens or by lines and knows the line it is in. LF, CRLF and a lone CR end a
// line. The text must outlive the cursor and everything it returned.
class TextCursor {
 public:
  // `source_name` begins every Where(); a UTF-8 byte order mark is skipped.
  TextCursor(std::string_view text, std::string_view source_name);

  // The next run of non-blank characters, over line ends; empty at the end of the text. '{' and '}'
  // are tokens of their own.
  std::string_view NextToken();
  // What NextToken() would return; the cursor stays.
  [[nodiscard]] std::string_view PeekToken() const;
  // What is left of this line up to '{' or '}', without
  // blanks at either end; stays before the brace.
  std::string_view RestOfLine();
  // The next whole line with something on it, or false at the end of the text. After it, line() is
  // its number and line_was_ended() tells whether a line end followed it.
  bool NextLine(std::string_view* line);

  [[nodiscard]] std::size_t line() const { return line_; }
  [[nodiscard]] bool line_was_ended() const { return line_was_ended_; }
  [[nodiscard]] std::string Where() const;  // "source_name:line"
  [[nodiscard]] Status Error(StatusCode code, std::string what, std::string todo = {}) const;

 private:
  void SkipLineEnd();

  std::string_view text_;
  std::string_view source_name_;
  std::size_t position_ = 0;
  std::size_t line_ = 1;
  bool pending_line_end_ = false;  // NextLine() leaves its line end to the next call, for line()
  bool line_was_ended_ = true;
};

}  // namespace furrow
