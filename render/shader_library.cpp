// SPDX-License-Identifier: Apache-2.0
#include "render/shader_library.h"

namespace furrow::render {
namespace {

std::string Define(std::string_view name, int value) {
  return std::string(name) + " " + std::to_string(value);
}

Result<gl::Shader> Compile(GLenum stage, std::string_view name,
                           std::span<const std::string> defines,
                           std::span<const ShaderFile> files) {
  const Result<ShaderSource> source = ExpandShader(name, defines, files);
  if (!source.ok()) return source.status();
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

std::vector<std::string> Defines(const SceneShader& shader) {
  return {
      Define("VIEW_FINAL", static_cast<int>(View::kFinal)),
      Define("VIEW_NORMAL", static_cast<int>(View::kNormal)),
      Define("VIEW_MASK_DYNAMIC", static_cast<int>(View::kMaskDynamic)),
      Define("VIEW_MASK_TEXTURE", static_cast<int>(View::kMaskTexture)),
      Define("VIEW_WEIGHTS", static_cast<int>(View::kWeights)),
      Define("VIEW_WIREFRAME", static_cast<int>(View::kWireframe)),
      Define("VIEW", static_cast<int>(shader.view)),
      Define("NORMAL_BLEND", static_cast<int>(shader.normal_blend)),
      Define("WRINKLE_TEXTURE", shader.wrinkle_texture),
      Define("WRINKLE_DYNAMIC", shader.wrinkle_dynamic),
      Define("HAS_BASE_COLOUR", shader.base_colour_map),
      Define("HAS_BASE_NORMAL", shader.base_normal_map),
      Define("HAS_ROUGHNESS", shader.roughness_map),
      Define("ALPHA_TEST", shader.alpha_test),
      Define("ACTIVE_MAPS", shader.active_maps),
      Define("MASK_LAYERS", shader.mask_layers),
      Define("MAP_SLOTS", shader.map_slots),
  };
}

std::vector<std::string> Defines(const CompositeShader& shader) {
  return {Define("SAMPLES", shader.samples), Define("TONEMAP", shader.tonemap)};
}

Result<gl::Program> BuildProgram(std::string_view vertex, std::string_view fragment,
                                 std::span<const std::string> defines,
                                 std::span<const ShaderFile> files) {
  const Result<gl::Shader> vertex_shader = Compile(GL_VERTEX_SHADER, vertex, defines, files);
  if (!vertex_shader.ok()) return vertex_shader.status();
  const Result<gl::Shader> fragment_shader = Compile(GL_FRAGMENT_SHADER, fragment, defines, files);
  if (!fragment_shader.ok()) return fragment_shader.status();
  gl::Program program(glCreateProgram());
  glAttachShader(program.name(), vertex_shader->name());
  glAttachShader(program.name(), fragment_shader->name());
  if (Status status = Link(program, fragment); !status.ok()) return status;
  return program;
}

Result<GLuint> ShaderLibrary::Get(const SceneShader& shader) {
  if (const auto found = scene_.find(shader); found != scene_.end()) return found->second.name();
  Result<gl::Program> program =
      BuildProgram("scene.vert.glsl", "scene.frag.glsl", Defines(shader), EmbeddedShaders());
  if (!program.ok()) return program.status();
  return scene_.emplace(shader, std::move(*program)).first->second.name();
}

Result<GLuint> ShaderLibrary::Get(const CompositeShader& shader) {
  if (const auto found = composite_.find(shader); found != composite_.end()) {
    return found->second.name();
  }
  Result<gl::Program> program = BuildProgram("fullscreen.vert.glsl", "composite.frag.glsl",
                                             Defines(shader), EmbeddedShaders());
  if (!program.ok()) return program.status();
  return composite_.emplace(shader, std::move(*program)).first->second.name();
}

}  // namespace furrow::render
