// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "render/gl/gl_objects.h"
#include "render/request/subjects.h"
#include "render/scene/frame_block.h"
#include "render/scene/motion.h"
#include "render/wrinkles/wrinkle_table.h"

namespace furrow::render {

// Buffers that the scene's shaders read in a frame: camera and lamps, the subjects' joints, and
// their wrinkles per group of surfaces.
class SceneBuffers {
 public:
  // Both arguments must outlive this object.
  SceneBuffers(std::span<const glm::mat4> inverse_bind_matrices, const WrinkleTables* tables);

  // Replaces the contents of all buffers. `subjects` may be freed afterwards.
  void Upload(const FrameBlock& frame, std::span<const NamedSubject> subjects,
              const WrinkleLayout& layout);
  // Replaces the block that only shaders with MOTION read.
  void UploadMotion(const MotionBlock& motion) { gl::Upload(motion_, &motion, sizeof(motion)); }
  // Binds the buffers that all surfaces share.
  void Bind() const;
  // Binds the buffers with the wrinkles of a group of surfaces, for the maps of `part`.
  void BindWrinkles(WrinkleGroup group, WrinklePart part = WrinklePart::kAll) const;

 private:
  struct GroupBuffers {
    std::array<gl::Buffer, kNumWrinkleParts> tables;  // by WrinklePart
    // [0]: masks of all vertices; [1]: masks of WrinklePart::kSliding.
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
  gl::Buffer motion_;
  gl::Buffer joints_;
  gl::Texture joints_view_;
  gl::Buffer influences_;
  GroupBuffers groups_[kNumWrinkleGroups];
  gl::Buffer palettes_[kNumWrinkleGroups + 1];  // by group, including kNone
};

}  // namespace furrow::render
