// SPDX-License-Identifier: Apache-2.0
#include "render/gl/shader_program.h"

#include <utility>

namespace furrow::render {
namespace {

// Compiles one stage. The driver's log, with file names instead of numbers, becomes the error.
Result<gl::Shader> Compile(GLenum stage, std::string_view name,
                           std::span<const std::string> defines,
                           std::span<const ShaderFile> files) {
  const Result<ShaderSource> source = ExpandShader(name, defines, files);
  FURROW_RETURN_IF_ERROR(source);
  gl::Shader shader(glCreateShader(stage));
  const char* text = source->text.c_str();
  glShaderSource(shader.name(), 1, &text, nullptr);
  glCompileShader(shader.name());
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE) return shader;
  GLint length = 0;
  glGetShaderiv(shader.name(), GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  glGetShaderInfoLog(shader.name(), length, &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  return Status(StatusCode::kInternal, "does not compile:\n" + NameSources(log, source->files),
                std::string(name));
}

Status Link(const gl::Program& program, std::string_view name) {
  glLinkProgram(program.name());
  GLint linked = GL_FALSE;
  glGetProgramiv(program.name(), GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) return {};
  GLint length = 0;
  glGetProgramiv(program.name(), GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  glGetProgramInfoLog(program.name(), length, &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  return {StatusCode::kInternal, "does not link:\n" + log, std::string(name)};
}

}  // namespace

std::string Define(std::string_view name, int value) {
  return std::string(name) + " " + std::to_string(value);
}

Result<gl::Program> BuildProgram(const ProgramFiles& program, std::span<const std::string> defines,
                                 std::span<const ShaderFile> files) {
  const std::pair<GLenum, std::string_view> stages[] = {
      {GL_VERTEX_SHADER, program.vertex},
      {GL_TESS_CONTROL_SHADER, program.tess_control},
      {GL_TESS_EVALUATION_SHADER, program.tess_evaluation},
      {GL_FRAGMENT_SHADER, program.fragment}};
  gl::Program built(glCreateProgram());
  for (const auto& [stage, name] : stages) {
    if (name.empty()) continue;
    const Result<gl::Shader> shader = Compile(stage, name, defines, files);
    FURROW_RETURN_IF_ERROR(shader);
    glAttachShader(built.name(), shader->name());  // keeps it as long as the program
  }
  const std::string_view name = program.fragment.empty() ? program.vertex : program.fragment;
  FURROW_RETURN_IF_ERROR(Link(built, name));
  return built;
}

}  // namespace furrow::render
