// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "render/settings/settings.h"
#include "wrinkle/solver/solver.h"
#include "wrinkle/weights/sliding_mask.h"

namespace furrow::render {

// A mask that the vertex shader evaluates. Mirrors DynamicMask of
// shaders/wrinkles/wrinkles_vert.glsl (std430).
struct DynamicMaskBlock {
  std::int32_t slot = 0;       // position of its map in the active list
  std::int32_t column = -1;    // column of the joints' influences; -1: a sliding mask
  std::int32_t lambda = 0;     // wrinkle::LambdaMode, for columns
  float smooth_width = 0.25f;  // of LambdaMode::kSmooth
  // Sliding masks only; model space, rest pose.
  glm::vec4 origin{0.0f};   // xyz: the joint, metres; w: the wrinkle weight
  glm::vec4 towards{0.0f};  // xyz: unit direction it moves to; w: cosine at which the mask is 0
  glm::vec4 bone{0.0f};     // xyz: unit direction of the bone; w: 1 / bone length, 1/m
  glm::vec4 extent{0.0f};   // Mask's above, below and radius, in bone lengths
};
static_assert(sizeof(DynamicMaskBlock) == 80);

// The DynamicMasks block of the shader, byte for byte: a header and the list.
[[nodiscard]] std::vector<std::uint8_t> DynamicMasksBlock(std::span<const DynamicMaskBlock> masks,
                                                          int num_columns);

// A joint that can raise a column of dynamic masks above 0.
struct SkinnedShare {
  int joint = 0;
  int column = 0;             // of DynamicMasks::influences()
  wrinkle::DynamicMask mask;  // the column's map and lambda
};

// The vertex masks of one subject: masks by skin weight, and masks that slide around joints.
class DynamicMasks {
 public:
  // `painted`: the character's rig, bound to its own skeleton. `skinning`: the same rig with
  // skinning masks instead of painted ones (MaskMode::kDynamic). Both must outlive this object.
  DynamicMasks(const wrinkle::RigBinding* painted, const wrinkle::RigBinding* skinning);

  // Evaluates all masks. `values` and `weights`: driver values and wrinkle weights of the painted
  // binding; both bindings have the same names.
  void Update(MaskMode mode, std::span<const float> values, std::span<const float> weights);

  // Appends the masks of wrinkle map `map` of the rig that are above 0 since the last Update().
  // Their slot is set to `map`.
  void Append(int map, std::vector<DynamicMaskBlock>* masks) const;
  // How strongly each joint raises each column, in [0, 1]: num_joints x num_columns(), joint-major.
  [[nodiscard]] std::span<const float> influences() const { return influences_; }
  [[nodiscard]] int num_columns() const { return static_cast<int>(columns_.size()); }
  // All (joint, column) pairs that can be above 0 in some pose.
  [[nodiscard]] std::vector<SkinnedShare> Shares(MaskMode mode) const;

 private:
  // One input of a region with a sliding mask.
  struct Slide {
    int map = -1;
    std::size_t weight = 0;       // index of RigBinding::weight_names()
    std::size_t first_value = 0;  // the values of the driver that moves the mask
    std::size_t num_values = 0;
    wrinkle::SlidingFrame frame;
    wrinkle::Mask mask;
  };
  [[nodiscard]] const wrinkle::RigBinding& BindingOf(MaskMode mode) const;
  void FindSlides(const wrinkle::RigBinding& binding);
  [[nodiscard]] DynamicMaskBlock BlockOf(const Slide& slide) const;

  const wrinkle::RigBinding* painted_;
  const wrinkle::RigBinding* skinning_;
  std::vector<Slide> slides_;
  std::span<const wrinkle::DynamicMask> columns_;  // of the binding that Update() used
  std::vector<float> influences_;
  std::vector<bool> column_works_;
  bool slides_work_ = false;
  std::vector<float> values_;
  std::vector<float> weights_;
};

}  // namespace furrow::render
