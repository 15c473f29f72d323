// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/mocap/neutral_frame.h"

namespace furrow::protocol::mocap {

// What a VMC sender has told so far: joints and blend shapes with their newest values, and the
// frame made of them. Private to the VMC adapter.
class VmcState {
 public:
  explicit VmcState(std::string subject);

  // Slot of a joint by the name on the wire; -1 where the name is not usable or there are too many.
  [[nodiscard]] int FindOrAddJoint(std::string_view name);
  [[nodiscard]] int AddRoot();
  // True where the joint was set since EndFrame().
  [[nodiscard]] bool HasInFrame(int joint) const;
  // Keeps the sign of the rotation continuous.
  void SetJoint(int joint, const Vec3& translation, const Quat& rotation);
  // False where the name is not usable or there are too many.
  [[nodiscard]] bool SetBlendShape(std::string_view name, float value);
  void EndFrame();
  // Forgets all joints and blend shapes; the numbers of frames and layouts go on.
  void Clear();

  // The frame as it stands, numbered; rebuilt in place, valid until the next call.
  [[nodiscard]] const NeutralFrame& Frame(std::int64_t capture_time_us, bool tracked);

 private:
  struct Joint {
    std::string name;
    int humanoid = -1;  // index in HumanoidJoints(); -1 for the root and foreign names
    bool is_root = false;
    bool in_frame = false;
    bool has_length = false;  // a translation other than zero has come
    Vec3 rest_translation;
    Vec3 translation;
    Quat rotation;
  };

  [[nodiscard]] int FindJoint(std::string_view name) const;
  [[nodiscard]] int AddJoint(std::string_view name, int humanoid, bool is_root);
  [[nodiscard]] int ParentOf(const Joint& joint) const;
  [[nodiscard]] int SlotOfHumanoid(int humanoid) const;
  void Rebuild();

  std::vector<Joint> joints_;
  std::vector<int> order_;  // slots, parents first: the frame's joints
  std::size_t last_joint_ = 0;
  std::size_t last_shape_ = 0;
  bool layout_changed_ = true;
  std::uint32_t next_sequence_ = 0;
  NeutralFrame frame_;  // holds the blend shapes' newest values
};

}  // namespace furrow::protocol::mocap
