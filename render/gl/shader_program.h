// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "base/status.h"
#include "render/gl/gl_objects.h"
#include "render/gl/shader_loader.h"

namespace furrow::render {

// The shader files of a program, by stage. An empty name leaves the stage out: tessellation needs
// both of its stages or none, and a program for transform feedback has no fragment stage.
struct ProgramFiles {
  std::string_view vertex;
  std::string_view fragment = {};
  std::string_view tess_control = {};
  std::string_view tess_evaluation = {};
};

// One "NAME VALUE" for BuildProgram(), and for ShaderLibrary::GetFullscreen().
[[nodiscard]] std::string Define(std::string_view name, int value);

// Expands, compiles and links the shaders that `program` names, taken from `files`, with `defines`
// ("NAME VALUE") in every stage. Needs a current context. Errors: those of ExpandShader(), and
// kInternal with the driver's log, in which file names replace source numbers.
[[nodiscard]] Result<gl::Program> BuildProgram(const ProgramFiles& program,
                                               std::span<const std::string> defines,
                                               std::span<const ShaderFile> files);

}  // namespace furrow::render
