// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/render/reference/target_reader.h"

#include <stdexcept>

#include "render/gl/gl_objects.h"
#include "tests/unit/render/test_character.h"

namespace furrow::render::test {

void TargetReader::AfterPass(std::string_view, const std::vector<Written>& written) {
  for (const Written& texture : written) {
    const TextureDesc& desc = texture.desc;
    if (desc.samples != 1) continue;
    FloatPicture picture(desc.width, desc.height);
    const bool depth = desc.format == PixelFormat::kDepth32F;
    std::vector<float> depths;
    if (depth) {
      depths.resize(picture.texels.size());
      glGetTextureImage(texture.texture, 0, GL_DEPTH_COMPONENT, GL_FLOAT,
                        static_cast<GLsizei>(depths.size() * sizeof(float)), depths.data());
      for (std::size_t i = 0; i < depths.size(); ++i) picture.texels[i] = glm::vec4(depths[i]);
    } else {
      glGetTextureImage(texture.texture, 0, GL_RGBA, GL_FLOAT,
                        static_cast<GLsizei>(picture.texels.size() * sizeof(glm::vec4)),
                        picture.texels.data());
    }
    targets_[std::string(texture.name)] = std::move(picture);
  }
}

const FloatPicture& TargetReader::Target(const std::string& name) const {
  const auto found = targets_.find(name);
  if (found != targets_.end()) return found->second;
  std::string names;
  for (const auto& [known, picture] : targets_) names += " '" + known + "'";
  throw std::out_of_range("no target '" + name + "', only" + names);
}

FloatPicture DrawTarget(const character::Character& character, const FrameRequest& request,
                        const std::string& target) {
  const std::unique_ptr<Renderer> renderer = Expect(Renderer::Create(character));
  TargetReader reader;
  renderer->SetObserver(&reader);
  (void)Expect(renderer->Render(request));
  renderer->SetObserver(nullptr);
  return reader.Target(target);
}

}  // namespace furrow::render::test
