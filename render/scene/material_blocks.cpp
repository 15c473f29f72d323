// SPDX-License-Identifier: Apache-2.0
#include "render/scene/material_blocks.h"

#include <algorithm>

namespace furrow::render {

void MaterialBlocks::BeginFrame(std::span<const NamedSubject> subjects) {
  for (int index = 0; index < gpu_->num_materials(); ++index) {
    const GpuMaterial& material = gpu_->material(index);
    if (material.binds.empty()) continue;
    Changed& changed = changed_[index];
    const std::vector<character::MaterialLook> before = std::move(changed.looks);
    changed.looks.clear();
    changed.look_of.clear();
    for (const NamedSubject& named : subjects) {
      const character::MaterialLook look =
          character::LookOf(material.source, material.binds, named.subject->shapes);
      const auto found = std::ranges::find(changed.looks, look);
      changed.look_of.push_back(static_cast<std::size_t>(found - changed.looks.begin()));
      if (found != changed.looks.end()) continue;
      changed.looks.push_back(look);
      const std::size_t place = changed.looks.size() - 1;
      if (place < before.size() && before[place] == look) continue;
      if (place == changed.blocks.size()) changed.blocks.push_back(gl::MakeBuffer());
      const MaterialBlock block = MakeMaterialBlock(material.source, look);
      gl::Upload(changed.blocks[place], &block, sizeof(block));
    }
  }
}

std::vector<MaterialBlocks::Group> MaterialBlocks::GroupsOf(
    int material, std::span<const std::uint32_t> subjects,
    std::span<const std::uint32_t> seen) const {
  const auto found = changed_.find(material);
  if (found == changed_.end()) {
    return {{gpu_->material(material).block.name(), {seen.begin(), seen.end()}}};
  }
  const Changed& changed = found->second;
  std::vector<Group> by_look(changed.looks.size());
  for (const std::uint32_t position : seen) {
    const std::size_t look = changed.look_of[subjects[position]];
    by_look[look].block = changed.blocks[look].name();
    by_look[look].seen.push_back(position);
  }
  std::erase_if(by_look, [](const Group& group) { return group.seen.empty(); });
  return by_look;
}

}  // namespace furrow::render
