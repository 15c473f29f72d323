// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"

// Embedded GLSL text, and the preprocessor that resolves its includes. No OpenGL here.
namespace furrow::render {

struct ShaderFile {
  std::string_view name;  // path below shaders/: "scene/scene.frag.glsl"
  std::string_view text;
};

// All files of shaders/ as they were when the library was built.
[[nodiscard]] std::span<const ShaderFile> EmbeddedShaders();

struct ShaderSource {
  std::string text;                // one string for glShaderSource
  std::vector<std::string> files;  // maps the source number of a #line to a file name
};

// Expands the file `name` from `files`. The result starts with `#version 450 core` and one
// `#define` for each "NAME VALUE" of `defines`. Each `#include "file"` line is replaced by that
// file, a path below shaders/, the first time that it appears. #line directives keep the line
// numbers of the files in the driver's messages.
//
// Errors: kNotFound (a file is not in `files`; `where` is the including file and line), kParse (an
// #include without a quoted name).
[[nodiscard]] Result<ShaderSource> ExpandShader(std::string_view name,
                                                std::span<const std::string> defines,
                                                std::span<const ShaderFile> files);

// Replaces source numbers in a driver's log by file names: "0:12(5): error" (Mesa) and "0(12) :
// error" (NVIDIA) become "scene/scene.frag.glsl:12(5): error" and "scene/scene.frag.glsl(12) :
// error".
[[nodiscard]] std::string NameSources(std::string_view log, std::span<const std::string> files);

}  // namespace furrow::render
