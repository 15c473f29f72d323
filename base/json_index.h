// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"

namespace furrow {

// Where every field of a JSON text stands, so that errors can name line and field; and the first,
// strict look at text from outside: syntax, depth and counts, before any other parser sees it.
//
// JSON as in RFC 8259, and // and /* */ comments. A field's path is written
// "drivers[3].hinge.axis", the root's is "". Does not own the text, which must outlive it.
class JsonIndex {
 public:
  static constexpr std::size_t kMaxBytes = 16u << 20;
  static constexpr int kMaxDepth = 24;
  static constexpr std::size_t kMaxElements = 400'000;

  // Errors: kParse (syntax), kLimit (size, depth, elements), kNonFinite (a number beyond float's
  // range), kSchema (a field twice). `where` is "<line>: <field>", without a file's name.
  [[nodiscard]] static Result<JsonIndex> Create(std::string_view text);

  // "<line>: <path>" of a field; for a field that is not there, the line of what should hold it.
  [[nodiscard]] std::string Where(std::string_view path) const;
  // The path of the element that a parser is in which has read up to `line` and `column` (both as
  // FlatBuffers counts them: from 1 and from 0).
  [[nodiscard]] std::string PathAt(int line, int column) const;
  // As PathAt(), for a parser that has just left an object and looks at the next token.
  [[nodiscard]] std::string PathClosedBefore(int line, int column) const;

 private:
  friend class JsonScanner;
  struct Element {
    int parent = -1;
    int line = 0;
    int position = -1;  // in a list; -1: the field `key` of an object
    std::string_view key;
    std::size_t begin = 0;  // of the key, or of the value in a list
    std::size_t end = 0;    // past the value
    bool is_object = false;
  };

  [[nodiscard]] std::string PathOf(int element) const;
  [[nodiscard]] int Find(std::string_view path) const;  // -1: not there
  [[nodiscard]] std::size_t OffsetOf(int line, int column) const;

  std::vector<Element> elements_;  // in document order; the root first
  std::vector<std::size_t> line_begins_;
};

}  // namespace furrow
