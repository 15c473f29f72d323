// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "base/status.h"

namespace furrow {

// Reads a text by tokens or by lines and tracks the line number. LF, CRLF and a lone CR end a line.
// The text must outlive the cursor and every view that the cursor returned.
class TextCursor {
 public:
  // `source_name` is the file name in Where(). A UTF-8 byte order mark is skipped.
  TextCursor(std::string_view text, std::string_view source_name);

  // The next run of non-blank characters, on this line or a later one; empty at the end of the
  // text.
  // '{' and '}' are separate tokens.
  std::string_view NextToken();
  // The token that NextToken() would return, without moving the cursor.
  [[nodiscard]] std::string_view PeekToken() const;
  // The rest of this line up to '{' or '}', without surrounding blanks. The cursor stops before the
  // brace.
  std::string_view RestOfLine();
  // Reads the next line that is not blank; false at the end of the text. Afterwards line() is its
  // number, and line_was_ended() tells whether a line end followed it.
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
  bool pending_line_end_ =
      false;  // NextLine() consumes its line end on the next call, so that line() stays
  bool line_was_ended_ = true;
};

}  // namespace furrow
