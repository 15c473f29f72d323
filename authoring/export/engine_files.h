// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace furrow::authoring {

// A text file that the build embeds: its path from the root of the sources, and its text.
struct EngineFile {
  std::string_view path;
  std::string_view text;
};

// The shaders and scripts of client/engines/ and the README templates of authoring/export/readme/
// that exports contain, as they were when the library was built.
[[nodiscard]] std::span<const EngineFile> EngineFiles();

}  // namespace furrow::authoring
