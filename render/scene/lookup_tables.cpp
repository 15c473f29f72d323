// SPDX-License-Identifier: Apache-2.0
#include "render/scene/lookup_tables.h"

#include "render/gl/shader_library.h"
#include "render/skin/beckmann.h"
#include "render/skin/subsurface_kernel.h"

namespace furrow::render {
namespace {

// A square table, filtered linearly between texel centres and clamped at its edges. The tables are
// computed once per process, but each context needs its own texture.
gl::Texture MakeTable(int size, GLenum internal, GLenum format, GLenum type, const void* texels) {
  gl::Texture texture = gl::MakeTexture(GL_TEXTURE_2D);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureStorage2D(texture.name(), 1, internal, size, size);
  glTextureSubImage2D(texture.name(), 0, 0, 0, size, size, format, type, texels);
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(texture.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(texture.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

}  // namespace

GLuint LookupTables::beckmann() {
  if (!beckmann_) {
    static const std::vector<std::uint16_t> table = BeckmannTable(kBeckmannTableSize);
    beckmann_ = MakeTable(kBeckmannTableSize, GL_R16, GL_RED, GL_UNSIGNED_SHORT, table.data());
  }
  return beckmann_.name();
}

GLuint LookupTables::specular_albedo() {
  if (!specular_albedo_) {
    static const std::vector<glm::vec4> table = TwoLobeAlbedoTable(kAlbedoTableSize);
    specular_albedo_ = MakeTable(kAlbedoTableSize, GL_RGBA32F, GL_RGBA, GL_FLOAT, table.data());
  }
  return specular_albedo_.name();
}

GLuint LookupTables::preintegrated() {
  if (!preintegrated_) {
    static const std::vector<glm::vec3> table =
        PreintegratedTable(HumanSkin(), kPreintegratedTableSize);
    preintegrated_ = MakeTable(kPreintegratedTableSize, GL_RGBA16F, GL_RGB, GL_FLOAT, table.data());
  }
  return preintegrated_.name();
}

}  // namespace furrow::render
