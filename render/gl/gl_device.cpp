// SPDX-License-Identifier: Apache-2.0
#include "render/gl/gl_device.h"

#include <algorithm>

namespace furrow::render {
namespace {

GLenum InternalFormat(PixelFormat format) {
  switch (format) {
    case PixelFormat::kRgba8: return GL_RGBA8;
    case PixelFormat::kRgba16F: return GL_RGBA16F;
    case PixelFormat::kRgba32F: return GL_RGBA32F;
    case PixelFormat::kR32F: return GL_R32F;
    case PixelFormat::kR8: return GL_R8;
    case PixelFormat::kDepth32F: return GL_DEPTH_COMPONENT32F;
  }
  return GL_RGBA8;
}

}  // namespace

TextureId GlDevice::CreateTexture(const TextureDesc& desc) {
  const GLenum target = desc.samples > 1 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D;
  gl::Texture texture = gl::MakeTexture(target);
  if (desc.samples > 1) {
    // Fixed sample locations (GL_TRUE): all attachments of a framebuffer must agree on them.
    glTextureStorage2DMultisample(texture.name(), desc.samples, InternalFormat(desc.format),
                                  desc.width, desc.height, GL_TRUE);
  } else {
    glTextureStorage2D(texture.name(), 1, InternalFormat(desc.format), desc.width, desc.height);
  }
  const TextureId id = texture.name();
  textures_.emplace(id, std::move(texture));
  return id;
}

void GlDevice::DestroyTexture(TextureId texture) {
  // OpenGL may reuse the name of a destroyed texture, so cached framebuffers must not refer to it.
  std::erase_if(framebuffers_, [&](const auto& entry) {
    return std::ranges::find(entry.first, texture) != entry.first.end();
  });
  textures_.erase(texture);
}

GLuint GlDevice::Framebuffer(std::span<const TextureId> colours, TextureId depth) {
  std::vector<TextureId> key{depth};
  key.insert(key.end(), colours.begin(), colours.end());
  gl::Framebuffer& framebuffer = framebuffers_[std::move(key)];
  if (!framebuffer) {
    framebuffer = gl::MakeFramebuffer();
    std::vector<GLenum> buffers;
    for (const TextureId colour : colours) {
      const auto attachment = static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + buffers.size());
      glNamedFramebufferTexture(framebuffer.name(), attachment, colour, 0);
      buffers.push_back(attachment);
    }
    // A shadow map has depth only: nothing may be written to the default colour attachment.
    if (buffers.empty()) {
      glNamedFramebufferDrawBuffer(framebuffer.name(), GL_NONE);
    } else {
      glNamedFramebufferDrawBuffers(framebuffer.name(), static_cast<GLsizei>(buffers.size()),
                                    buffers.data());
    }
    if (depth != 0) glNamedFramebufferTexture(framebuffer.name(), GL_DEPTH_ATTACHMENT, depth, 0);
  }
  return framebuffer.name();
}

}  // namespace furrow::render
