// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"

// GLSL text: what is embedded, and the little preprocessor that puts it together. No OpenGL here.
namespace furrow::render {

struct ShaderFile {
  std::string_view name;  // "scene/scene.frag.glsl"
  std::string_view text;
};

// The files of shaders/, as they were when the library was built.
[[nodiscard]] std::span<const ShaderFile> EmbeddedShaders();

struct ShaderSource {
  std::string text;                // one string for glShaderSource
  std::vector<std::string> files;  // a #line's source number -> file name
};

// `name` with its `#include "file"` lines replaced by those files, each once, and with `#version
// 450 core` and a `#define` for every "NAME VALUE" in front. #line directives keep the driver's
// messages on the lines of the files. Errors: kNotFound (a file that is not in `files`; `where` is
// the including file and line), kParse (an #include that is not followed by a quoted name).
[[nodiscard]] Result<ShaderSource> ExpandShader(std::string_view name,
                                                std::span<const std::string> defines,
                                                std::span<const ShaderFile> files);

// A driver's log with source numbers replaced by file names: "0:12(5): error" (Mesa) and
// "0(12) : error" (NVIDIA) become "scene/scene.frag.glsl:12(5): error" and "scene/scene.frag.glsl(12) : error".
[[nodiscard]] std::string NameSources(std::string_view log, std::span<const std::string> files);

}  // namespace furrow::render
