// SPDX-License-Identifier: Apache-2.0
#include "render/scene/morph_sums.h"

#include <algorithm>

namespace furrow::render {
namespace {

// Of shaders/scene/morph.glsl.
constexpr GLuint kMorphSumsUnit = 16;
constexpr GLint kRowsLocation = 0;
// Sums of this size stay in the processor's cache between their computation and their use.
constexpr std::size_t kBytesAtATime = std::size_t{1} << 22;

}  // namespace

void MorphSums::BeginFrame(std::span<const NamedSubject> subjects) {
  shapes_.resize(subjects.size());
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    const std::span<const float> shapes = subjects[i].subject->shapes;
    shapes_[i].assign(shapes.begin(), shapes.end());
  }
}

bool MorphSums::Moves(std::size_t mesh, std::span<const std::uint32_t> subjects) const {
  const MeshMorphs& morphs = gpu_->meshes()[mesh].morphs;
  return !morphs.empty() && std::ranges::any_of(subjects, [&](std::uint32_t subject) {
    return morphs.Moves(shapes_[subject]);
  });
}

std::size_t MorphSums::MaxSubjects(std::size_t mesh) const {
  const std::size_t bytes = gpu_->meshes()[mesh].morphs.num_floats() * sizeof(float);
  return std::max<std::size_t>(1, kBytesAtATime / std::max<std::size_t>(1, bytes));
}

void MorphSums::Bind(std::size_t mesh, std::span<const std::uint32_t> subjects) {
  const MeshMorphs& morphs = gpu_->meshes()[mesh].morphs;
  Sums& sums = sums_[mesh];
  weights_.clear();
  for (const std::uint32_t subject : subjects) morphs.AppendWeights(shapes_[subject], &weights_);
  if (!sums.buffer) {
    sums.buffer = gl::MakeBuffer();
    sums.view = gl::MakeTexture(GL_TEXTURE_BUFFER);
  }
  if (weights_ != sums.weights) {
    const std::size_t size = morphs.num_floats();
    values_.resize(subjects.size() * size);
    for (std::size_t i = 0; i < subjects.size(); ++i) {
      morphs.Sum(shapes_[subjects[i]], std::span(values_).subspan(i * size, size));
    }
    gl::Upload(sums.buffer, values_.data(), values_.size() * sizeof(float));
    glTextureBuffer(sums.view.name(), GL_RGB32F, sums.buffer.name());
    sums.weights = weights_;
  }
  glBindTextureUnit(kMorphSumsUnit, sums.view.name());
  glUniform1ui(kRowsLocation, static_cast<GLuint>(morphs.num_rows()));
}

}  // namespace furrow::render
