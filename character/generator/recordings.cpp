// SPDX-License-Identifier: Apache-2.0
#include "character/generator/recordings.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/gtc/quaternion.hpp>

#include "character/generator/mesh_tools.h"

namespace furrow::character::generator {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kDegrees = kPi / 180.0f;

// A reference pose that comes, stays and goes: seconds; `pose` without side means both sides, the
// right one a little later.
struct Action {
  const char* pose;
  float start;
  float onset;
  float end;  // when it begins to go
  float offset;
  float peak;
};

struct Script {
  const char* name;
  float seconds;
  std::vector<Action> actions;
  std::vector<float> blinks;
  bool walks = false;
};

const std::vector<Script>& Scripts() {
  static const std::vector<Script> scripts = {
      {"happiness",
       10.0f,
       {{"lip_corner_pull", 1.2f, 0.55f, 7.2f, 1.0f, 0.95f},
        {"cheek_raise", 1.35f, 0.55f, 7.0f, 0.9f, 0.85f},
        {"upper_lip_raise", 1.5f, 0.5f, 6.6f, 0.8f, 0.3f},
        {"jaw_open", 3.0f, 0.4f, 4.6f, 0.7f, 0.3f},
        {"lip_corner_pull", 3.0f, 0.4f, 4.6f, 0.7f, 0.2f},
        {"brow_raise_outer", 2.9f, 0.4f, 4.2f, 0.6f, 0.3f}},
       {0.6f, 2.6f, 5.4f, 8.3f}},
      {"anger",
       10.0f,
       {{"brow_lower", 1.1f, 0.4f, 7.6f, 0.9f, 1.0f},
        {"lid_raise", 1.3f, 0.35f, 7.2f, 0.6f, 0.7f},
        {"lid_tighten", 2.6f, 0.4f, 6.9f, 0.6f, 0.7f},
        {"lip_press", 1.4f, 0.45f, 7.3f, 0.8f, 1.0f},
        {"chin_raise", 1.6f, 0.5f, 6.8f, 0.8f, 0.4f},
        {"nose_wrinkle", 3.6f, 0.4f, 5.6f, 0.8f, 0.45f},
        {"lip_corner_down", 1.6f, 0.5f, 7.2f, 0.9f, 0.35f}},
       {0.5f, 5.7f, 8.6f}},
      {"sadness",
       10.0f,
       {{"brow_raise_inner", 1.1f, 0.6f, 7.6f, 1.3f, 1.0f},
        {"brow_lower", 1.4f, 0.6f, 7.4f, 1.2f, 0.3f},
        {"lip_corner_down", 1.4f, 0.6f, 7.6f, 1.3f, 0.95f},
        {"chin_raise", 2.2f, 0.6f, 6.8f, 1.1f, 0.75f},
        {"look_down", 3.4f, 0.6f, 6.4f, 0.8f, 0.6f}},
       {0.7f, 3.0f, 6.2f, 8.7f}},
      {"disgust",
       10.0f,
       {{"nose_wrinkle", 1.1f, 0.4f, 6.9f, 1.0f, 1.0f},
        {"upper_lip_raise", 1.2f, 0.45f, 6.8f, 1.0f, 0.85f},
        {"brow_lower", 1.25f, 0.45f, 6.6f, 0.9f, 0.6f},
        {"cheek_raise", 1.4f, 0.5f, 6.6f, 0.9f, 0.45f},
        {"lip_corner_down", 1.7f, 0.5f, 6.8f, 1.0f, 0.6f},
        {"chin_raise", 2.0f, 0.5f, 6.2f, 0.9f, 0.6f},
        {"look_left", 4.0f, 0.3f, 5.6f, 0.4f, 0.5f}},
       {0.5f, 3.6f, 8.2f}},
      {"performance",
       12.0f,
       {// Surprise: brows up, jaw drops.
        {"brow_raise_inner", 0.8f, 0.35f, 2.2f, 0.5f, 1.0f},
        {"brow_raise_outer", 0.85f, 0.35f, 2.2f, 0.5f, 1.0f},
        {"lid_raise", 0.8f, 0.3f, 2.0f, 0.4f, 0.9f},
        {"jaw_open", 0.95f, 0.35f, 2.1f, 0.5f, 0.45f},
        // A smile.
        {"lip_corner_pull", 2.6f, 0.5f, 4.6f, 0.7f, 1.0f},
        {"cheek_raise", 2.75f, 0.5f, 4.5f, 0.6f, 0.9f},
        // A frown.
        {"brow_lower", 5.2f, 0.4f, 7.0f, 0.6f, 1.0f},
        {"lip_press", 5.35f, 0.4f, 6.8f, 0.5f, 0.8f},
        {"lid_tighten", 5.4f, 0.4f, 6.8f, 0.5f, 0.7f},
        // Disgust.
        {"nose_wrinkle", 7.4f, 0.35f, 8.8f, 0.6f, 1.0f},
        {"upper_lip_raise", 7.45f, 0.4f, 8.8f, 0.6f, 0.8f},
        {"brow_lower", 7.4f, 0.4f, 8.6f, 0.6f, 0.5f},
        // Sorrow.
        {"brow_raise_inner", 9.4f, 0.5f, 10.8f, 0.8f, 1.0f},
        {"lip_corner_down", 9.5f, 0.5f, 10.9f, 0.8f, 0.9f},
        {"chin_raise", 9.8f, 0.5f, 10.8f, 0.7f, 0.8f}},
       {0.3f, 2.4f, 5.0f, 7.1f, 9.2f, 11.7f}},
      {"walk", 10.0f, {}, {0.9f, 4.4f, 8.0f}, true},
  };
  return scripts;
}

float Weight(const Action& action, float time, float delay) {
  const float t = time - delay;
  // Never quite steady at the peak.
  const float breath = 1.0f - 0.06f * (0.5f - 0.5f * std::cos(1.7f * (t - action.start)));
  return action.peak * breath * SmoothStep(action.start, action.start + action.onset, t) *
         SmoothStep(action.end + action.offset, action.end, t);
}

// Down in 0.08 s, up in 0.16 s.
float BlinkWeight(float since) {
  if (since < 0.0f) return 0.0f;
  return SmoothStep(0.0f, 0.08f, since) * SmoothStep(0.27f, 0.11f, since);
}

// The pose of one frame under way.
class FramePose {
 public:
  FramePose(const wrinkle::Rig& rig, const wrinkle::Skeleton& skeleton)
      : rig_(rig),
        skeleton_(skeleton),
        frame_(skeleton.rest_pose().begin(), skeleton.rest_pose().end()) {}

  [[nodiscard]] Status Apply(const std::string& pose, float weight) {
    const auto found =
        std::find_if(rig_.reference_poses.begin(), rig_.reference_poses.end(),
                     [&](const wrinkle::ReferencePose& p) { return p.name == pose; });
    if (found == rig_.reference_poses.end()) {
      return Status(StatusCode::kNotFound, "no reference pose is called \"" + pose + "\"");
    }
    for (const wrinkle::JointDelta& delta : found->joints) {
      const int joint = skeleton_.Find(delta.joint);
      if (joint == wrinkle::kNoJoint) {
        return Status(StatusCode::kNotFound, "no joint is called \"" + delta.joint + "\"", pose);
      }
      frame_[joint].translation += delta.translation * weight;
      frame_[joint].rotation =
          frame_[joint].rotation * glm::slerp(glm::quat(1, 0, 0, 0), delta.rotation, weight);
    }
    return Status();
  }

  // An action unit of both sides where the rig has it by side.
  [[nodiscard]] Status ApplyBoth(const std::string& pose, float left, float right) {
    const bool sided =
        std::any_of(rig_.reference_poses.begin(), rig_.reference_poses.end(),
                    [&](const wrinkle::ReferencePose& p) { return p.name == pose + "_l"; });
    if (!sided) return Apply(pose, left);
    if (Status status = Apply(pose + "_l", left); !status.ok()) return status;
    return Apply(pose + "_r", right);
  }

  void Turn(const char* name, float x, float y, float z) {  // degrees, x first
    const int joint = skeleton_.Find(name);
    if (joint == wrinkle::kNoJoint) return;
    const glm::quat q = glm::angleAxis(z * kDegrees, glm::vec3(0, 0, 1)) *
                        glm::angleAxis(y * kDegrees, glm::vec3(0, 1, 0)) *
                        glm::angleAxis(x * kDegrees, glm::vec3(1, 0, 0));
    frame_[joint].rotation = frame_[joint].rotation * q;
  }

  void Move(const char* name, const glm::vec3& by) {
    const int joint = skeleton_.Find(name);
    if (joint != wrinkle::kNoJoint) frame_[joint].translation += by;
  }

  std::vector<wrinkle::Transform> Take() { return std::move(frame_); }

 private:
  const wrinkle::Rig& rig_;
  const wrinkle::Skeleton& skeleton_;
  std::vector<wrinkle::Transform> frame_;
};

// Arms hang; the chest breathes; the head drifts by a few degrees.
void Stand(float t, FramePose* pose) {
  const float breath = std::sin(2.0f * kPi * t / 4.1f);
  pose->Turn("shoulder_l", 0, 0, -6.0f + 0.5f * breath);
  pose->Turn("shoulder_r", 0, 0, 6.0f - 0.5f * breath);
  pose->Turn("upper_arm_l", 0, 0, -68);
  pose->Turn("upper_arm_r", 0, 0, 68);
  pose->Turn("lower_arm_l", 0, -14, 0);
  pose->Turn("lower_arm_r", 0, 14, 0);
  pose->Turn("chest", -0.6f * breath, 0, 0);
  const float nod = 1.3f * std::sin(0.9f * t) + 0.7f * std::sin(2.3f * t + 1.0f);
  const float shake = 2.2f * std::sin(0.61f * t + 0.4f) + 0.8f * std::sin(1.7f * t);
  const float tilt = 1.2f * std::sin(0.47f * t + 2.0f);
  pose->Turn("neck", 0.4f * nod, 0.4f * shake, 0.4f * tilt);
  pose->Turn("head", 0.6f * nod, 0.6f * shake, 0.6f * tilt);
}

// A step a half second and a little, 1.25 m a second, along +Z.
void Walk(float t, FramePose* pose) {
  const float start = SmoothStep(0.2f, 1.2f, t);
  const float phase = 2.0f * kPi * t / 1.1f;
  const float swing = std::sin(phase);
  pose->Move("hips",
             {0.018f * std::sin(phase) * start, (-0.02f + 0.018f * std::cos(2.0f * phase)) * start,
              1.25f * (t - 0.7f) * start});
  pose->Turn("hips", 2.0f * start, 5.0f * swing * start, 1.5f * swing * start);
  pose->Turn("spine", 0, -5.0f * swing * start, 0);
  pose->Turn("chest", 0, -6.0f * swing * start, 0);
  for (const float side : {1.0f, -1.0f}) {
    const float s = std::sin(phase + (side > 0.0f ? 0.0f : kPi));
    const float lift = std::max(0.0f, std::sin(phase + (side > 0.0f ? 0.0f : kPi) + 1.35f));
    const bool left = side > 0.0f;
    pose->Turn(left ? "upper_leg_l" : "upper_leg_r", (-25.0f * s - 6.0f) * start, 0, 0);
    pose->Turn(left ? "lower_leg_l" : "lower_leg_r", (8.0f + 52.0f * lift * lift) * start, 0, 0);
    pose->Turn(left ? "foot_l" : "foot_r", (10.0f * s - 4.0f) * start, 0, 0);
    pose->Turn(left ? "toes_l" : "toes_r", -18.0f * std::max(0.0f, -s) * start, 0, 0);
    // The arm hangs along its own X: a swing is a turn about its Y.
    pose->Turn(left ? "upper_arm_l" : "upper_arm_r", 0, side * 20.0f * s * start, 0);
    pose->Turn(left ? "lower_arm_l" : "lower_arm_r", 0, side * (-14.0f + 10.0f * s) * start, 0);
  }
}

}  // namespace

std::vector<std::string> RecordingNames() {
  std::vector<std::string> names;
  for (const Script& script : Scripts()) names.emplace_back(script.name);
  return names;
}

Result<Recording> MakeRecording(std::string_view name, const wrinkle::Rig& rig,
                                const wrinkle::Skeleton& skeleton) {
  const auto script = std::find_if(Scripts().begin(), Scripts().end(),
                                   [&](const Script& s) { return s.name == name; });
  if (script == Scripts().end()) {
    return Status(StatusCode::kNotFound, "no recording is called \"" + std::string(name) + "\"");
  }
  Recording recording;
  recording.name = script->name;
  const int count = static_cast<int>(script->seconds * kFramesPerSecond);
  for (int i = 0; i < count; ++i) {
    const float t = static_cast<float>(i) / kFramesPerSecond;
    FramePose pose(rig, skeleton);
    for (const Action& action : script->actions) {
      const float left = Weight(action, t, 0.0f);
      const float right = Weight(action, t, 0.05f) * 0.93f;
      if (Status status = pose.ApplyBoth(action.pose, left, right); !status.ok()) return status;
    }
    float blink = 0.0f;
    for (const float at : script->blinks) blink = std::max(blink, BlinkWeight(t - at));
    if (Status status = pose.ApplyBoth("blink", blink, blink); !status.ok()) return status;
    Stand(t, &pose);
    if (script->walks) Walk(t, &pose);
    recording.frames.push_back(pose.Take());
  }
  return recording;
}

}  // namespace furrow::character::generator
