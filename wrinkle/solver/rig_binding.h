// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>

#include "wrinkle/drivers/common/bind_options.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/skeleton/skeleton.h"
#include "wrinkle/weights/influence_table.h"

namespace furrow::wrinkle {

struct BindingData;  // private to wrinkle/

// A rig bound to one skeleton: names are resolved and reference poses are turned into
// displacements. Immutable; all subjects with that skeleton share it.
class RigBinding {
 public:
  // Errors: those of CheckRigFields() (rig_check.h), kNotFound (names the driver and the joint),
  // and kInvalidArgument for a driver that cannot work on this skeleton.
  [[nodiscard]] static Result<RigBinding> Create(const Rig& rig, const Skeleton& skeleton,
                                                 std::span<const std::string> blend_shape_names,
                                                 const BindOptions& options = {});
  RigBinding(RigBinding&&) noexcept;
  RigBinding& operator=(RigBinding&&) noexcept;
  ~RigBinding();

  // "<region>.<map>", in the order of the rig's regions and their feeds.
  [[nodiscard]] std::span<const std::string> weight_names() const;
  // "<driver>.<value>", in the order of the rig's drivers.
  [[nodiscard]] std::span<const std::string> driver_value_names() const;
  // The columns of JointInfluenceJob: one per wrinkle map and lambda that skinning masks use, in
  // the order of the rig's regions.
  [[nodiscard]] std::span<const DynamicMask> dynamic_masks() const;
  // The pairs of joint and column that some driver values raise above 0: joint * columns + column,
  // sorted.
  [[nodiscard]] std::vector<std::size_t> InfluencedPlaces() const;
  // Names of the rig that the skeleton or the stream lacks, if BindOptions allow that.
  [[nodiscard]] std::span<const std::string> missing_joints() const;
  [[nodiscard]] std::span<const std::string> missing_blend_shapes() const;
  // Drivers that bind but cannot do what was probably meant: a reference pose that moves none of
  // its driver's control points (the value is always 0), reference poses of an nnls driver that
  // almost depend on one another, a control point that does not hang from the anchor, drivers
  // without an anchor and, if BindOptions allow missing joints, a driver that cannot work on this
  // skeleton.
  [[nodiscard]] std::span<const std::string> warnings() const;
  [[nodiscard]] const Skeleton& skeleton() const;
  [[nodiscard]] const Rig& rig() const;
  [[nodiscard]] const BindingData& data() const { return *data_; }

 private:
  explicit RigBinding(std::unique_ptr<BindingData> data);
  std::unique_ptr<BindingData> data_;
};

}  // namespace furrow::wrinkle
