// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"

namespace furrow::gltf {

// The parts of a glTF file, as views into its bytes.
struct Container {
  std::string_view json;
  std::string_view binary;  // the first BIN chunk; empty if there is none
  bool has_binary = false;
  std::vector<std::string> warnings;  // "field: what"
};

// Splits a binary glTF (GLB version 2; glTF 2.0, section 4) or wraps a JSON text (.gltf).
//
// - The first four bytes decide: "glTF" begins a GLB. Otherwise the first character that is not
//   blank must be '{'. A UTF-8 byte order mark is skipped.
// - Header and chunk lengths are checked against the actual size. Bytes after the stated end, a cut
//   chunk header at the end and chunk lengths that are not multiples of 4 are warnings.
//
// Errors: kParse, kLimit (kMaxFileBytes), kUnsupported (another GLB version). `where` is a field:
// "header", "header.length", "chunks[1].length".
[[nodiscard]] Result<Container> SplitContainer(std::string_view bytes);

}  // namespace furrow::gltf
