// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace furrow::server {

// A file that a client has sent. The buffer is not filled with zeros first, so memory that a client
// announces, but does not send, is not used.
struct UploadedFile {
  std::string name;  // without folders
  std::unique_ptr<char[]> buffer;
  std::size_t size = 0;  // bytes

  [[nodiscard]] std::string_view bytes() const { return {buffer.get(), size}; }
};

}  // namespace furrow::server
