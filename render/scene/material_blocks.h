// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "character/mesh/material_bind.h"
#include "render/gl/gl_objects.h"
#include "render/request/subjects.h"
#include "render/scene/gpu_character.h"

namespace furrow::render {

// The uniform blocks of materials that shapes change (character::MaterialBind), for the subjects of
// a frame. Subjects that look alike share a block, so that one draw call shows them.
class MaterialBlocks {
 public:
  // `gpu` must outlive this object.
  explicit MaterialBlocks(const GpuCharacter* gpu) : gpu_(gpu) {}

  // Works out the looks of all subjects. Needs a current context.
  void BeginFrame(std::span<const NamedSubject> subjects);

  // Subjects that draw a material with one block.
  struct Group {
    GLuint block = 0;
    std::vector<std::uint32_t> seen;  // some of the positions that GroupsOf() received
  };
  // Splits `seen`, positions in `subjects`, into groups. `subjects`: numbers of the frame's
  // subjects.
  [[nodiscard]] std::vector<Group> GroupsOf(int material, std::span<const std::uint32_t> subjects,
                                            std::span<const std::uint32_t> seen) const;

 private:
  struct Changed {
    std::vector<character::MaterialLook> looks;  // different ones
    std::vector<gl::Buffer> blocks;              // by look; may be more
    std::vector<std::size_t> look_of;            // by subject: an index of `looks`
  };
  const GpuCharacter* gpu_;
  std::map<int, Changed> changed_;  // by material, those with binds
};

}  // namespace furrow::render
