// SPDX-License-Identifier: Apache-2.0
#include "base/json_index.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

namespace furrow {
namespace {

// Checks RFC 8259's grammar of a number, because from_chars() also accepts "inf", "1." and "01".
bool IsNumber(std::string_view token) {
  std::size_t i = 0;
  const auto digits = [&] {
    const std::size_t begin = i;
    while (i < token.size() && token[i] >= '0' && token[i] <= '9') ++i;
    return i - begin;
  };
  if (i < token.size() && token[i] == '-') ++i;
  const std::size_t integer_begin = i;
  const std::size_t integer_digits = digits();
  if (integer_digits == 0 || (integer_digits > 1 && token[integer_begin] == '0')) return false;
  if (i < token.size() && token[i] == '.') {
    ++i;
    if (digits() == 0) return false;
  }
  if (i < token.size() && (token[i] == 'e' || token[i] == 'E')) {
    ++i;
    if (i < token.size() && (token[i] == '+' || token[i] == '-')) ++i;
    if (digits() == 0) return false;
  }
  return i == token.size();
}

// False for finite numbers that a float cannot hold, which would become infinite later.
bool FitsFloat(std::string_view number) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error == std::errc::result_out_of_range) {
    // from_chars() reports underflow and overflow alike; the exponent's sign tells them apart.
    // Underflow is as good as 0.
    const std::size_t e = number.find_first_of("eE");
    return e != std::string_view::npos && number.substr(e + 1).starts_with('-');
  }
  return end == number.data() + number.size() &&
         std::abs(value) <= std::numeric_limits<float>::max();
}

// The bytes that make up a word, so that an error message can quote the whole of it.
bool IsWordByte(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' ||
         c == '+' || c == '.' || c == '_';
}

}  // namespace

// One pass over the text by recursive descent, at most kMaxDepth deep.
class JsonScanner {
 public:
  JsonScanner(std::string_view text, JsonIndex* index) : text_(text), index_(index) {}

  Status Run() {
    index_->line_begins_ = {0};
    if (text_.size() > JsonIndex::kMaxBytes) {
      return {StatusCode::kLimit,
              "the text has " + std::to_string(text_.size()) + " bytes; at most " +
                  std::to_string(JsonIndex::kMaxBytes) + " are accepted",
              "1"};
    }
    FURROW_RETURN_IF_ERROR(SkipSpace());
    // Element 0 is the root. Parents have smaller indices than their children.
    Enter(-1, -1, {});
    if (AtEnd()) return Fail("the text is empty; expected a JSON object");
    if (Peek() != '{') return Fail("expected a JSON object, which begins with '{'");
    FURROW_RETURN_IF_ERROR(Value(0, 1));
    current_ = 0;
    FURROW_RETURN_IF_ERROR(SkipSpace());
    return AtEnd() ? Status() : Fail("text after the end of the JSON object");
  }

 private:
  [[nodiscard]] bool AtEnd() const { return at_ >= text_.size(); }
  [[nodiscard]] char Peek() const { return text_[at_]; }

  // An error at the current place: "<line>: <path>".
  Status Fail(std::string what, StatusCode code = StatusCode::kParse) {
    const std::string path = current_ < 0 ? std::string() : index_->PathOf(current_);
    return {code, std::move(what), std::to_string(line_) + (path.empty() ? "" : ": " + path)};
  }

  int Enter(int parent, int position, std::string_view key) {
    current_ = static_cast<int>(index_->elements_.size());
    index_->elements_.push_back({parent, line_, position, key, at_, at_, false});
    return current_;
  }

  void Advance() {
    if (text_[at_++] == '\n') {
      ++line_;
      index_->line_begins_.push_back(at_);
    }
  }

  Status SkipSpace() {
    while (!AtEnd()) {
      const char c = Peek();
      if (c == ' ' || c == '\t' || c == '\r' || c == '\n') {
        Advance();
      } else if (text_.substr(at_, 2) == "//") {
        while (!AtEnd() && Peek() != '\n') Advance();
      } else if (text_.substr(at_, 2) == "/*") {
        const std::size_t close = text_.find("*/", at_ + 2);
        if (close == std::string_view::npos) return Fail("unterminated comment");
        while (at_ < close + 2) Advance();
      } else {
        break;
      }
    }
    return {};
  }

  // Finds the end of a string, without decoding it. Paths show keys as they are written.
  Status String(std::string_view* content) {
    const std::size_t begin = ++at_;
    while (!AtEnd() && Peek() != '"') {
      if (static_cast<unsigned char>(Peek()) < 0x20) {
        return Fail("unterminated string, or a control character inside a string");
      }
      // An escaped quote does not end the string.
      at_ += Peek() == '\\' ? 2 : 1;
    }
    if (AtEnd()) return Fail("unterminated string");
    *content = text_.substr(begin, at_ - begin);
    ++at_;
    return {};
  }

  Status Word() {
    const std::size_t begin = at_;
    while (!AtEnd() && IsWordByte(Peek())) ++at_;
    const std::string_view word = text_.substr(begin, at_ - begin);
    if (word.empty()) return Fail(std::string("unexpected '") + Peek() + "'");
    if (word == "true" || word == "false" || word == "null") return {};
    if (!IsNumber(word)) {
      return Fail("'" + std::string(word.substr(0, 40)) +
                  "' is neither a number nor true, false or null");
    }
    if (!FitsFloat(word)) {
      return Fail("the number " + std::string(word.substr(0, 40)) + " is too large",
                  StatusCode::kNonFinite);
    }
    return {};
  }

  Status Value(int element, int depth) {
    if (AtEnd()) return Fail("the text ends where a value is expected");
    Status status;
    std::string_view ignored;
    switch (Peek()) {
      case '{': status = Object(element, depth); break;
      case '[': status = List(element, depth); break;
      case '"': status = String(&ignored); break;
      default: status = Word();
    }
    index_->elements_[element].end = at_;
    return status;
  }

  // Limits against hostile texts: the depth bounds the call stack, the number of elements bounds
  // memory.
  Status CheckRoom(int depth) {
    if (depth > JsonIndex::kMaxDepth) {
      return Fail("nested deeper than " + std::to_string(JsonIndex::kMaxDepth), StatusCode::kLimit);
    }
    if (index_->elements_.size() >= JsonIndex::kMaxElements) {
      return Fail("more than " + std::to_string(JsonIndex::kMaxElements) + " values",
                  StatusCode::kLimit);
    }
    return {};
  }

  // Reads what follows an item. `closed` is set at the closing bracket and cleared after a comma.
  Status ItemEnd(char close, bool* closed) {
    FURROW_RETURN_IF_ERROR(SkipSpace());
    if (AtEnd()) return Fail(std::string("the text ends where ',' or '") + close + "' is expected");
    if (Peek() != ',' && Peek() != close) {
      return Fail(std::string("expected ',' or '") + close + "', found '" + Peek() + "'");
    }
    *closed = Peek() == close;
    ++at_;
    return *closed ? Status() : SkipSpace();
  }

  Status Field(int parent, int depth, std::vector<std::string_view>* keys) {
    if (AtEnd() || Peek() != '"') {
      return Fail("expected a field name in double quotes (is there an extra ','?)");
    }
    const int element = Enter(parent, -1, {});
    std::string_view key;
    FURROW_RETURN_IF_ERROR(String(&key));
    index_->elements_[element].key = key;
    // A linear search, which the limit of 64 fields per object bounds.
    if (std::find(keys->begin(), keys->end(), key) != keys->end()) {
      return Fail("the field appears twice", StatusCode::kSchema);
    }
    if (keys->size() >= 64) return Fail("too many fields in one object", StatusCode::kLimit);
    keys->push_back(key);
    FURROW_RETURN_IF_ERROR(SkipSpace());
    if (AtEnd() || Peek() != ':') return Fail("expected ':' after the field name");
    ++at_;
    FURROW_RETURN_IF_ERROR(SkipSpace());
    return Value(element, depth);
  }

  Status Object(int parent, int depth) {
    index_->elements_[parent].is_object = true;
    ++at_;
    FURROW_RETURN_IF_ERROR(SkipSpace());
    std::vector<std::string_view> keys;
    bool closed = !AtEnd() && Peek() == '}';
    if (closed) ++at_;
    while (!closed) {
      current_ = parent;
      FURROW_RETURN_IF_ERROR(CheckRoom(depth));
      FURROW_RETURN_IF_ERROR(Field(parent, depth + 1, &keys));
      FURROW_RETURN_IF_ERROR(ItemEnd('}', &closed));
    }
    return {};
  }

  Status List(int parent, int depth) {
    ++at_;
    FURROW_RETURN_IF_ERROR(SkipSpace());
    bool closed = !AtEnd() && Peek() == ']';
    if (closed) ++at_;
    for (int position = 0; !closed; ++position) {
      current_ = parent;
      FURROW_RETURN_IF_ERROR(CheckRoom(depth));
      const int element = Enter(parent, position, {});
      FURROW_RETURN_IF_ERROR(Value(element, depth + 1));
      FURROW_RETURN_IF_ERROR(ItemEnd(']', &closed));
    }
    return {};
  }

  std::string_view text_;
  JsonIndex* index_;
  std::size_t at_ = 0;
  int line_ = 1;
  int current_ = -1;  // the element that an error names
};

Result<JsonIndex> JsonIndex::Create(std::string_view text) {
  JsonIndex index;
  FURROW_RETURN_IF_ERROR(JsonScanner(text, &index).Run());
  return index;
}

std::string JsonIndex::PathOf(int element) const {
  std::string path;
  // From the element to the root, hence the insertion at the front.
  for (int i = element; i > 0; i = elements_[i].parent) {
    const Element& e = elements_[i];
    const std::string step =
        e.position < 0 ? std::string(e.key) : "[" + std::to_string(e.position) + "]";
    path.insert(0, path.empty() || path.front() == '[' ? step : step + ".");
  }
  return path;
}

int JsonIndex::Find(std::string_view path) const {
  for (int i = 0; i < static_cast<int>(elements_.size()); ++i) {
    const Element& e = elements_[i];
    // Most fields fail this cheap test, which saves building their paths.
    if (e.position < 0 && !path.ends_with(e.key)) continue;
    if (PathOf(i) == path) return i;
  }
  return -1;
}

std::string JsonIndex::Where(std::string_view path) const {
  std::string_view known = path;
  int element = Find(known);
  // A missing field has no line. Its object does, or the object above; the root (path "") always
  // exists.
  while (element < 0) {
    const std::size_t cut = known.find_last_of(".[");
    known = cut == std::string_view::npos ? std::string_view() : known.substr(0, cut);
    element = Find(known);
  }
  const std::string line = std::to_string(elements_[element].line);
  return path.empty() ? line : line + ": " + std::string(path);
}

std::size_t JsonIndex::OffsetOf(int line, int column) const {
  const int last = static_cast<int>(line_begins_.size());
  // The parser may report a line past the end.
  return line_begins_[std::clamp(line, 1, last) - 1] +
         static_cast<std::size_t>(std::max(column, 0));
}

std::string JsonIndex::PathAt(int line, int column) const {
  const std::size_t offset = OffsetOf(line, column);
  int found = 0;
  for (int i = 0; i < static_cast<int>(elements_.size()); ++i) {
    if (elements_[i].begin < offset) found = i;
  }
  return PathOf(found);
}

std::string JsonIndex::PathClosedBefore(int line, int column) const {
  const std::size_t offset = OffsetOf(line, column);
  int found = 0;
  std::size_t latest = 0;
  for (int i = 0; i < static_cast<int>(elements_.size()); ++i) {
    const Element& e = elements_[i];
    // The next token may close an object right at `offset`; skip that object.
    if (!e.is_object || e.end >= offset || e.end < latest) continue;
    latest = e.end;
    found = i;
  }
  return PathOf(found);
}

}  // namespace furrow
