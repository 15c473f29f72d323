// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"

namespace furrow {

// The line and path of every field of a JSON text, for error messages. Create() is also the first
// check of untrusted text: it enforces syntax and the limits below before another parser runs.
//
// Accepts RFC 8259 plus // and /* */ comments. A path looks like "drivers[3].hinge.axis"; the
// root's path is "". Lines count from 1. The index refers to the text, which must outlive it.
class JsonIndex {
 public:
  // Far above any real rig, and small enough that hostile text cannot exhaust stack or memory.
  static constexpr std::size_t kMaxBytes = 16u << 20;
  static constexpr int kMaxDepth = 24;  // objects and lists in one another
  static constexpr std::size_t kMaxElements = 400'000;

  // Errors: kParse (syntax), kLimit (size, depth, elements), kNonFinite (a number outside float's
  // range), kSchema (duplicate field). `where` is "<line>: <path>", without the file name.
  [[nodiscard]] static Result<JsonIndex> Create(std::string_view text);

  // "<line>: <path>" of a field. A missing field gets the line of the object that should hold it.
  [[nodiscard]] std::string Where(std::string_view path) const;
  // The path of the element that a parser has reached at `line` (from 1) and `column` (from 0), as
  // FlatBuffers counts them.
  [[nodiscard]] std::string PathAt(int line, int column) const;
  // The path of the object that a parser has just finished, if it has reached the next token at
  // `line` and `column`.
  [[nodiscard]] std::string PathClosedBefore(int line, int column) const;

 private:
  friend class JsonScanner;
  struct Element {
    int parent = -1;
    int line = 0;
    int position = -1;  // index in a list, or -1 for the field `key` of an object
    std::string_view key;
    std::size_t begin = 0;  // offset of the key, or of a list entry's value
    std::size_t end = 0;    // offset just past the value
    bool is_object = false;
  };

  [[nodiscard]] std::string PathOf(int element) const;
  [[nodiscard]] int Find(std::string_view path) const;  // -1 if absent
  [[nodiscard]] std::size_t OffsetOf(int line, int column) const;

  std::vector<Element> elements_;  // in document order; the root first
  std::vector<std::size_t> line_begins_;
};

}  // namespace furrow
