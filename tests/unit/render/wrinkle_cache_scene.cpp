// SPDX-License-Identifier: Apache-2.0
#include "wrinkle_cache_scene.h"

#include <cmath>

namespace furrow::render::test {

character::Character HeadWithLooks() {
  character::Character head = MakeHead();
  const auto add = [&](character::Picture picture) {
    head.pictures.push_back(std::move(picture));
    return static_cast<int>(head.pictures.size()) - 1;
  };
  head.materials[0].normal_texture = add(NormalMapOf("pores", 256, [](float u, float v) {
    return 0.001f * std::sin(90.0f * u) * std::sin(70.0f * v);
  }));
  head.materials[0].base_colour_texture = add(MakePicture("skin", 128, [](float u, float v) {
    return glm::vec4(0.8f, 0.6f + 0.2f * u, 0.5f + 0.3f * v, 1.0f);
  }));
  for (const auto& [map, name] : {std::pair(0, "pale"), {1, "red"}}) {
    head.rig.wrinkle_maps[static_cast<std::size_t>(map)].colour = name;
    head.rig.wrinkle_maps[static_cast<std::size_t>(map)].cavity = "cavity";
    const float green = map == 0 ? 0.9f : 0.6f;
    head.rig_pictures.emplace_back(name, add(MakePicture(name, 64, [=](float u, float) {
                                     return glm::vec4(0.9f, green * (0.5f + 0.5f * u), green, 1.0f);
                                   })));
  }
  head.rig_pictures.emplace_back(
      "cavity",
      add(MakePicture("cavity", 32, [](float, float v) { return glm::vec4(0.4f + 0.5f * v); })));
  return head;
}

FrameRequest RequestOf(const Subject& subject, const Camera& camera, View view, int size) {
  FrameRequest request;
  request.model = subject.model;
  request.binding = &subject.binding;
  request.wrinkle_weights = subject.weights;
  request.filtered_values = subject.driver_values;
  request.camera = camera;
  request.width = request.height = size;
  request.settings.view = view;
  return request;
}

std::vector<float> Numbers(const std::vector<glm::vec4>& pixels) {
  std::vector<float> numbers;
  for (const glm::vec4& pixel : pixels) numbers.insert(numbers.end(), {pixel.r, pixel.g, pixel.b});
  return numbers;
}

}  // namespace furrow::render::test
