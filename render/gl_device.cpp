// SPDX-License-Identifier: Apache-2.0
#include "render/gl_device.h"

namespace furrow::render {
namespace {

GLenum InternalFormat(PixelFormat format) {
  switch (format) {
    case PixelFormat::kRgba8: return GL_RGBA8;
    case PixelFormat::kRgba16F: return GL_RGBA16F;
    case PixelFormat::kRgba32F: return GL_RGBA32F;
    case PixelFormat::kDepth32F: return GL_DEPTH_COMPONENT32F;
  }
  return GL_RGBA8;
}

}  // namespace

TextureId GlDevice::CreateTexture(const TextureDesc& desc) {
  const GLenum target = desc.samples > 1 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D;
  gl::Texture texture = gl::MakeTexture(target);
  if (desc.samples > 1) {
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
  std::erase_if(framebuffers_, [&](const auto& entry) {
    return entry.first.first == texture || entry.first.second == texture;
  });
  textures_.erase(texture);
}

GLuint GlDevice::Framebuffer(TextureId colour, TextureId depth) {
  gl::Framebuffer& framebuffer = framebuffers_[{colour, depth}];
  if (!framebuffer) {
    framebuffer = gl::MakeFramebuffer();
    glNamedFramebufferTexture(framebuffer.name(), GL_COLOR_ATTACHMENT0, colour, 0);
    if (depth != 0) glNamedFramebufferTexture(framebuffer.name(), GL_DEPTH_ATTACHMENT, depth, 0);
  }
  return framebuffer.name();
}

}  // namespace furrow::render
