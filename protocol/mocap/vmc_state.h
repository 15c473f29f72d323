// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/mocap/neutral_frame.h"

namespace furrow::protocol::mocap {

// The state of a VMC sender: its joints and blend shapes with their newest values, and the frame
// made of them. Private to the VMC adapter.
class VmcState {
 public:
  explicit VmcState(std::string subject);

  // Returns the slot of a joint by its name on the wire, or -1 if the name is unusable or there are
  // too many joints.
  [[nodiscard]] int FindOrAddJoint(std::string_view name);
  // Returns the slot of the joint "Root", and adds it if necessary; -1 if there are too many
  // joints.
  [[nodiscard]] int AddRoot();
  // True if the joint in slot `joint` was set since the last EndFrame().
  [[nodiscard]] bool HasInFrame(int joint) const;
  // Sets the pose of the joint in a slot (-1: does nothing), in Furrow's axes. Of `rotation` and
  // its negative, stores the one nearer to the previous rotation, so that rotations interpolate.
  void SetJoint(int joint, const Vec3& translation, const Quat& rotation);
  // Returns false if the name is unusable or there are too many blend shapes.
  [[nodiscard]] bool SetBlendShape(std::string_view name, float value);
  // Begins the next frame: HasInFrame() is then false for all joints. Values stay.
  void EndFrame();
  // Discards all joints and blend shapes. NeutralFrame::sequence and ::layout continue to count.
  void Clear();

  // Returns the current frame with the next sequence number. Valid until the next call.
  [[nodiscard]] const NeutralFrame& Frame(std::int64_t capture_time_us, bool tracked);

 private:
  struct Joint {
    std::string name;
    int humanoid = -1;  // index in HumanoidJoints(); -1 for the root and foreign names
    bool is_root = false;
    bool in_frame = false;
    bool has_length = false;  // a non-zero translation was received
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
  std::vector<int> order_;  // slots of the frame's joints, parents first
  std::size_t last_joint_ = 0;
  std::size_t last_shape_ = 0;
  bool layout_changed_ = true;
  std::uint32_t next_sequence_ = 0;
  NeutralFrame frame_;  // also holds the newest values of the blend shapes
};

}  // namespace furrow::protocol::mocap
