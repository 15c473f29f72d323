// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>

#include "protocol/messages/text.h"

namespace furrow::capi {

// Reads a text of a program, at most `most` bytes of plain UTF-8; a null pointer is an empty text.
// Reads one byte more at most, in case the zero byte is missing. Returns false, with a cut text, if
// it is longer or not plain.
[[nodiscard]] inline bool ReadText(const char* text, std::size_t most, std::string* out) {
  out->clear();
  if (text == nullptr) return true;
  const std::size_t size = strnlen(text, most + 1);
  out->assign(text, std::min(size, most));
  return size <= most && protocol::IsPlainText(*out);
}

}  // namespace furrow::capi
