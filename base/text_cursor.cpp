// SPDX-License-Identifier: Apache-2.0
#include "base/text_cursor.h"

#include <algorithm>
#include <utility>

#include "base/text.h"

namespace furrow {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

bool IsLineEnd(char c) { return c == '\n' || c == '\r'; }
bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
bool IsBrace(char c) { return c == '{' || c == '}'; }

}  // namespace

TextCursor::TextCursor(std::string_view text, std::string_view source_name)
    : text_(text), source_name_(source_name) {
  if (text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());
}

void TextCursor::SkipLineEnd() {
  // LF, CRLF and CR alone each count as one line, as editors count them.
  const bool crlf =
      text_[position_] == '\r' && position_ + 1 < text_.size() && text_[position_ + 1] == '\n';
  position_ += crlf ? 2 : 1;
  ++line_;
}

std::string_view TextCursor::NextToken() {
  while (position_ < text_.size()) {
    const char c = text_[position_];
    if (IsLineEnd(c)) {
      SkipLineEnd();
    } else if (IsBlank(c)) {
      ++position_;
    } else {
      break;
    }
  }
  const std::size_t begin = position_;
  while (position_ < text_.size()) {
    const char c = text_[position_];
    if (IsLineEnd(c) || IsBlank(c)) break;
    // Braces are tokens of their own, even without blanks around them ("ROOT Hips{").
    if (IsBrace(c)) {
      if (position_ == begin) ++position_;
      break;
    }
    ++position_;
  }
  return text_.substr(begin, position_ - begin);
}

std::string_view TextCursor::PeekToken() const {
  TextCursor ahead = *this;
  return ahead.NextToken();
}

std::string_view TextCursor::RestOfLine() {
  while (position_ < text_.size() && IsBlank(text_[position_])) ++position_;
  const std::size_t begin = position_;
  while (position_ < text_.size() && !IsLineEnd(text_[position_]) && !IsBrace(text_[position_])) {
    ++position_;
  }
  std::string_view rest = text_.substr(begin, position_ - begin);
  while (!rest.empty() && IsBlank(rest.back())) rest.remove_suffix(1);
  return rest;
}

bool TextCursor::NextLine(std::string_view* line) {
  while (true) {
    // The line's end is consumed by the next call, so that Where() still names this line while the
    // caller reports an error in it.
    if (pending_line_end_) SkipLineEnd();
    pending_line_end_ = false;
    if (position_ >= text_.size()) return false;
    const std::size_t begin = position_;
    while (position_ < text_.size() && !IsLineEnd(text_[position_])) ++position_;
    pending_line_end_ = line_was_ended_ = position_ < text_.size();
    *line = text_.substr(begin, position_ - begin);
    if (!std::all_of(line->begin(), line->end(), IsBlank)) return true;
  }
}

std::string TextCursor::Where() const { return furrow::Where(source_name_, line_); }

Status TextCursor::Error(StatusCode code, std::string what, std::string todo) const {
  return {code, std::move(what), Where(), std::move(todo)};
}

}  // namespace furrow
