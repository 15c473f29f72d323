// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "render/gl/gl_objects.h"
#include "render/request/subjects.h"
#include "render/scene/gpu_character.h"

namespace furrow::render {

// The sums of the morph targets of a frame's subjects, on the GPU for shaders/scene/morph.glsl.
// They are computed here and not in the shader, because a face moves by dozens of sparse targets
// but is posed once per frame. Sums of unchanged weights are kept.
class MorphSums {
 public:
  // `gpu` must outlive this object.
  explicit MorphSums(const GpuCharacter* gpu) : gpu_(gpu) {}

  // Copies the subjects' weights.
  void BeginFrame(std::span<const NamedSubject> subjects);

  // `mesh`: an index of GpuCharacter::meshes(). `subjects`: numbers of the frame's subjects.

  // True if the shapes of some of the subjects move the mesh.
  [[nodiscard]] bool Moves(std::size_t mesh, std::span<const std::uint32_t> subjects) const;
  // The number of subjects that one Bind() can take, at least 1. It bounds the memory.
  [[nodiscard]] std::size_t MaxSubjects(std::size_t mesh) const;
  // Binds the sums of the subjects, in the order of the instances to draw. Precondition: the mesh
  // has morph targets. The current program must be a PoseShader with morph_parts.
  void Bind(std::size_t mesh, std::span<const std::uint32_t> subjects);

 private:
  struct Sums {
    gl::Buffer buffer;
    gl::Texture view;            // of `buffer`
    std::vector<float> weights;  // from which `buffer` was computed; drawn weights per subject
  };
  const GpuCharacter* gpu_;
  std::vector<std::vector<float>> shapes_;  // by subject
  std::map<std::size_t, Sums> sums_;        // by mesh
  std::vector<float> weights_;              // scratch memory
  std::vector<float> values_;
};

}  // namespace furrow::render
