// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "render/gl/gl_objects.h"
#include "render/scene/frame_block.h"
#include "render/request/subjects.h"
#include "render/wrinkles/wrinkle_table.h"

namespace furrow::render {

// What the scene's shaders know of a frame, as buffers: camera and lamps, the subjects' joints, and
// their wrinkles by group of surfaces.
class SceneBuffers {
 public:
  // Both outlive it.
  SceneBuffers(std::span<const glm::mat4> inverse_bind_matrices, const WrinkleTables* tables);

  void Upload(const FrameBlock& frame, std::span<const NamedSubject> subjects,
              const WrinkleLayout& layout);
  // What is the same for all surfaces.
  void Bind() const;
  void BindWrinkles(WrinkleGroup group, WrinklePart part = WrinklePart::kAll) const;

 private:
  struct GroupBuffers {
    std::array<gl::Buffer, kNumWrinkleParts> tables;  // by WrinklePart
    // Of all vertices' masks, and of those of WrinklePart::kSliding.
    std::array<gl::Buffer, 2> dynamic_masks;
    std::array<gl::Buffer, 2> first_masks;
    gl::Buffer subject_weights;
    gl::Texture subject_weights_view;
  };
  void UploadJoints(std::span<const NamedSubject> subjects);
  void UploadWrinkles(const WrinkleLayout& layout);
  void UploadMasks(const WrinkleTable& table, WrinklePart part, GroupBuffers* group);

  std::span<const glm::mat4> inverse_bind_matrices_;
  const WrinkleTables* tables_;
  gl::Buffer frame_;
  gl::Buffer joints_;
  gl::Buffer influences_;
  GroupBuffers groups_[kNumWrinkleGroups];
  gl::Buffer palettes_[kNumWrinkleGroups + 1];  // by group, kNone included
};

}  // namespace furrow::render
