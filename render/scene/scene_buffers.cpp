// SPDX-License-Identifier: Apache-2.0
#include "render/scene/scene_buffers.h"

#include <vector>

namespace furrow::render {
namespace {

// Binding points of the shaders in shaders/scene/ and shaders/wrinkles/.
enum UniformBinding : GLuint { kFrameBlock = 0, kWrinkleTable = 2, kMotionBlock = 3 };
enum StorageBinding : GLuint {
  kJointInfluences = 1,
  kMaskPalette = 2,
  kDynamicMasks = 3,
  kFirstMasks = 4
};
constexpr GLuint kSubjectWeightsUnit = 13;
constexpr GLuint kJointRowsUnit = 15;

// Index of GroupBuffers::dynamic_masks and first_masks.
std::size_t MasksIndex(WrinklePart part) { return part == WrinklePart::kSliding ? 1 : 0; }

}  // namespace

SceneBuffers::SceneBuffers(std::span<const glm::mat4> inverse_bind_matrices,
                           const WrinkleTables* tables)
    : inverse_bind_matrices_(inverse_bind_matrices), tables_(tables) {
  for (gl::Buffer* buffer : {&frame_, &motion_, &joints_, &influences_}) *buffer = gl::MakeBuffer();
  joints_view_ = gl::MakeTexture(GL_TEXTURE_BUFFER);
  for (GroupBuffers& group : groups_) {
    for (auto* buffers : {&group.dynamic_masks, &group.first_masks}) {
      for (gl::Buffer& buffer : *buffers) buffer = gl::MakeBuffer();
    }
    for (gl::Buffer& table : group.tables) table = gl::MakeBuffer();
    group.subject_weights = gl::MakeBuffer();
    group.subject_weights_view = gl::MakeTexture(GL_TEXTURE_BUFFER);
  }
  for (int group = 0; group <= kNumWrinkleGroups; ++group) {
    const auto palette = tables_->mask_palette(static_cast<WrinkleGroup>(group));
    palettes_[group] = gl::MakeStaticBuffer(palette.data(), palette.size_bytes());
  }
}

void SceneBuffers::Upload(const FrameBlock& frame, std::span<const NamedSubject> subjects,
                          const WrinkleLayout& layout) {
  gl::Upload(frame_, &frame, sizeof(frame));
  UploadJoints(subjects);
  UploadWrinkles(layout);
}

// Matrices are multiplied once per joint here, not once per vertex in the shader. The last row of
// an affine matrix is constant and left out.
void SceneBuffers::UploadJoints(std::span<const NamedSubject> subjects) {
  std::vector<glm::vec4> rows;
  const std::size_t num_joints = inverse_bind_matrices_.size();
  rows.reserve(subjects.size() * num_joints * 3);
  for (const NamedSubject& named : subjects) {
    const PosedSubject& subject = *named.subject;
    for (std::size_t joint = 0; joint < num_joints; ++joint) {
      const glm::mat4 rowwise =
          glm::transpose(subject.placement * subject.model[joint] * inverse_bind_matrices_[joint]);
      for (int row = 0; row < 3; ++row) rows.push_back(rowwise[row]);
    }
  }
  gl::Upload(joints_, rows.data(), rows.size() * sizeof(glm::vec4));
  glTextureBuffer(joints_view_.name(), GL_RGBA32F, joints_.name());
}

void SceneBuffers::UploadWrinkles(const WrinkleLayout& layout) {
  for (int index = 0; index < kNumWrinkleGroups; ++index) {
    const WrinkleTable& table = tables_->table(static_cast<WrinkleGroup>(index));
    GroupBuffers& group = groups_[index];
    // Small blocks are uploaded for all parts, because which part a material uses is decided later.
    for (int part = 0; part < kNumWrinkleParts; ++part) {
      const auto block =
          WrinkleBlock(table, static_cast<WrinklePart>(part), tables_->num_maps(), layout);
      gl::Upload(group.tables[static_cast<std::size_t>(part)], block.data(), block.size());
    }
    UploadMasks(table, WrinklePart::kAll, &group);
    if (table.num_sliding > 0) UploadMasks(table, WrinklePart::kSliding, &group);
    const auto weights = SubjectWeights(table, tables_->num_maps(), layout);
    gl::Upload(group.subject_weights, weights.data(), weights.size() * sizeof(glm::vec4));
    glTextureBuffer(group.subject_weights_view.name(), GL_RGBA32F, group.subject_weights.name());
  }
  gl::Upload(influences_, tables_->influences().data(), tables_->influences().size_bytes());
}

void SceneBuffers::UploadMasks(const WrinkleTable& table, WrinklePart part, GroupBuffers* group) {
  const std::size_t index = MasksIndex(part);
  const PartMasks masks = MasksOf(table, part);
  const auto block = DynamicMasksBlock(masks.masks, tables_->mask_columns());
  gl::Upload(group->dynamic_masks[index], block.data(), block.size());
  gl::Upload(group->first_masks[index], masks.first.data(),
             masks.first.size() * sizeof(std::uint32_t));
}

void SceneBuffers::Bind() const {
  glBindBufferBase(GL_UNIFORM_BUFFER, kFrameBlock, frame_.name());
  glBindBufferBase(GL_UNIFORM_BUFFER, kMotionBlock, motion_.name());
  glBindTextureUnit(kJointRowsUnit, joints_view_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kJointInfluences, influences_.name());
}

// kNone draws no wrinkles, but its shader still declares the blocks, so some buffers must be bound.
void SceneBuffers::BindWrinkles(WrinkleGroup wrinkle_group, WrinklePart part) const {
  const bool none = wrinkle_group == WrinkleGroup::kNone;
  const GroupBuffers& group = groups_[none ? 0 : static_cast<int>(wrinkle_group)];
  const gl::Buffer& table = group.tables[static_cast<std::size_t>(part)];
  glBindBufferBase(GL_UNIFORM_BUFFER, kWrinkleTable, table.name());
  const std::size_t masks = MasksIndex(part);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kDynamicMasks, group.dynamic_masks[masks].name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kFirstMasks, group.first_masks[masks].name());
  glBindTextureUnit(kSubjectWeightsUnit, group.subject_weights_view.name());
  const GLuint palette = palettes_[static_cast<int>(wrinkle_group)].name();
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kMaskPalette, palette);
}

}  // namespace furrow::render
