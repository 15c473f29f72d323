// SPDX-License-Identifier: Apache-2.0
#include "protocol/mocap/vmc_state.h"

#include <algorithm>
#include <utility>

#include "protocol/messages/limits.h"
#include "protocol/messages/text.h"
#include "protocol/mocap/humanoid.h"

namespace furrow::protocol::mocap {
namespace {

constexpr std::size_t kMaxVmcJoints = 128;
constexpr std::string_view kRootName = "Root";
constexpr int kHips = 0;

bool IsUsable(std::string_view name) {
  return !name.empty() && name.size() <= kMaxNameBytes && IsPlainText(name);
}

char Lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool EqualWithoutCase(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return Lower(x) == Lower(y); });
}

bool IsZero(const Vec3& v) { return v == Vec3{}; }

}  // namespace

VmcState::VmcState(std::string subject) { frame_.subject = std::move(subject); }

int VmcState::FindOrAddJoint(std::string_view name) {
  // Senders keep the order of joints from frame to frame, so the next slot nearly always matches.
  if (last_joint_ + 1 < joints_.size() && joints_[last_joint_ + 1].name == name) {
    return static_cast<int>(++last_joint_);
  }
  const int found = FindJoint(name);
  if (found >= 0) last_joint_ = static_cast<std::size_t>(found);
  if (found >= 0 || !IsUsable(name)) return found;
  return AddJoint(name, FindHumanoidJoint(name), false);
}

int VmcState::AddRoot() {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (joints_[i].is_root) return static_cast<int>(i);
  }
  return AddJoint(kRootName, -1, true);
}

int VmcState::FindJoint(std::string_view name) const {
  const auto found = std::find_if(joints_.begin(), joints_.end(),
                                  [name](const Joint& joint) { return joint.name == name; });
  return found == joints_.end() ? -1 : static_cast<int>(found - joints_.begin());
}

int VmcState::AddJoint(std::string_view name, int humanoid, bool is_root) {
  if (joints_.size() == kMaxVmcJoints) return -1;
  Joint joint;
  joint.name = name;
  joint.humanoid = humanoid;
  joint.is_root = is_root;
  if (humanoid >= 0) {
    joint.rest_translation = HumanoidJoints()[static_cast<std::size_t>(humanoid)].rest_translation;
  }
  joints_.push_back(std::move(joint));
  layout_changed_ = true;
  return static_cast<int>(joints_.size()) - 1;
}

bool VmcState::HasInFrame(int joint) const {
  return joints_[static_cast<std::size_t>(joint)].in_frame;
}

void VmcState::SetJoint(int index, const Vec3& translation, const Quat& rotation) {
  if (index < 0) return;
  Joint& joint = joints_[static_cast<std::size_t>(index)];
  // The first non-zero translation becomes rest. It stays: a new rest means a new layout, hence a
  // new skeleton offer.
  if (!joint.has_length && !joint.is_root && !IsZero(translation)) {
    joint.has_length = true;
    joint.rest_translation = translation;
    layout_changed_ = true;
  }
  joint.translation = joint.has_length || joint.is_root ? translation : joint.rest_translation;
  const Quat& old = joint.rotation;
  const float dot =
      old.x * rotation.x + old.y * rotation.y + old.z * rotation.z + old.w * rotation.w;
  joint.rotation = dot < 0.0f ? Quat{-rotation.x, -rotation.y, -rotation.z, -rotation.w} : rotation;
  joint.in_frame = true;
}

bool VmcState::SetBlendShape(std::string_view name, float value) {
  std::vector<NeutralBlendShape>& shapes = frame_.blend_shapes;
  if (last_shape_ + 1 < shapes.size() && EqualWithoutCase(shapes[last_shape_ + 1].name, name)) {
    shapes[++last_shape_].value = value;
    return true;
  }
  const auto found = std::find_if(
      shapes.begin(), shapes.end(),
      [name](const NeutralBlendShape& shape) { return EqualWithoutCase(shape.name, name); });
  if (found != shapes.end()) {
    found->value = value;
    last_shape_ = static_cast<std::size_t>(found - shapes.begin());
    return true;
  }
  if (!IsUsable(name) || shapes.size() == kMaxBlendShapes) return false;
  shapes.push_back({std::string(name), value});
  last_shape_ = shapes.size() - 1;
  layout_changed_ = true;
  return true;
}

void VmcState::EndFrame() {
  for (Joint& joint : joints_) joint.in_frame = false;
}

void VmcState::Clear() {
  joints_.clear();
  frame_.blend_shapes.clear();
  last_joint_ = 0;
  last_shape_ = 0;
  layout_changed_ = true;
}

int VmcState::SlotOfHumanoid(int humanoid) const {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (joints_[i].humanoid == humanoid) return static_cast<int>(i);
  }
  return -1;
}

// Returns the nearest ancestor that the sender sent. The root joint is the ancestor of all others.
int VmcState::ParentOf(const Joint& joint) const {
  if (joint.is_root) return -1;
  int ancestor = joint.humanoid < 0
                     ? kHips
                     : HumanoidJoints()[static_cast<std::size_t>(joint.humanoid)].parent;
  while (ancestor >= 0) {
    const int slot = SlotOfHumanoid(ancestor);
    if (slot >= 0) return slot;
    ancestor = HumanoidJoints()[static_cast<std::size_t>(ancestor)].parent;
  }
  const auto root = std::find_if(joints_.begin(), joints_.end(),
                                 [](const Joint& other) { return other.is_root; });
  return root == joints_.end() ? -1 : static_cast<int>(root - joints_.begin());
}

// Orders the frame's joints: root, humanoid joints in the order of the table (parents first), then
// all others.
void VmcState::Rebuild() {
  order_.resize(joints_.size());
  for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<int>(i);
  const auto rank = [this](int slot) {
    const Joint& joint = joints_[static_cast<std::size_t>(slot)];
    return joint.is_root ? -1 : joint.humanoid >= 0 ? joint.humanoid : kNumHumanoidJoints;
  };
  std::stable_sort(order_.begin(), order_.end(),
                   [&rank](int a, int b) { return rank(a) < rank(b); });
  frame_.joints.assign(order_.size(), {});
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const Joint& joint = joints_[static_cast<std::size_t>(order_[i])];
    const auto parent = std::find(order_.begin(), order_.end(), ParentOf(joint));
    frame_.joints[i].name = joint.name;
    frame_.joints[i].parent =
        parent == order_.end() ? -1 : static_cast<int>(parent - order_.begin());
    frame_.joints[i].rest_translation = joint.rest_translation;
  }
  ++frame_.layout;
  layout_changed_ = false;
}

const NeutralFrame& VmcState::Frame(std::int64_t capture_time_us, bool tracked) {
  if (layout_changed_) Rebuild();
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const Joint& joint = joints_[static_cast<std::size_t>(order_[i])];
    frame_.joints[i].translation = joint.translation;
    frame_.joints[i].rotation = joint.rotation;
  }
  frame_.capture_time_us = capture_time_us;
  frame_.tracked = tracked;
  frame_.sequence = next_sequence_++;
  return frame_;
}

}  // namespace furrow::protocol::mocap
