// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/recordings/recordings.h"

#include <algorithm>
#include <cmath>

#include "authoring/generator/mesh/mesh_tools.h"
#include "authoring/generator/recordings/body_moves.h"
#include "authoring/generator/recordings/frame_pose.h"
#include "authoring/generator/recordings/recording_scripts.h"
#include "base/scalar.h"
#include "base/status.h"

namespace furrow::authoring {
namespace {

// How far something that comes, stays and goes is there at a time.
float Presence(float start, float onset, float end, float offset, float t) {
  return Smoothstep(start, start + onset, t) * Smoothstep(end + offset, end, t);
}

float Weight(const Action& action, float t) {
  // The expression is never quite steady at its peak.
  const float breath = 1.0f - 0.06f * (0.5f - 0.5f * std::cos(1.7f * (t - action.start)));
  return action.peak * breath * Presence(action.start, action.onset, action.end, action.offset, t);
}

// Down in 0.08 s, up in 0.16 s.
float BlinkWeight(float since) {
  if (since < 0.0f) return 0.0f;
  return Smoothstep(0.0f, 0.08f, since) * Smoothstep(0.27f, 0.11f, since);
}

// A reference pose with its weights. Where actions of one pose overlap, the larger weight counts.
struct PoseWeight {
  std::string pose;
  float left;
  float right;
};

std::vector<PoseWeight> FaceAt(const Script& script, float t) {
  std::vector<PoseWeight> face;
  const auto add = [&](const std::string& pose, float left, float right) {
    const auto found =
        std::find_if(face.begin(), face.end(), [&](const PoseWeight& p) { return p.pose == pose; });
    if (found == face.end()) {
      face.push_back({pose, left, right});
    } else {
      found->left = std::max(found->left, left);
      found->right = std::max(found->right, right);
    }
  };
  for (const Action& action : script.actions) {
    add(action.pose, Weight(action, t), Weight(action, t - 0.05f) * 0.93f);
  }
  for (const float at : script.blinks) add("blink", BlinkWeight(t - at), BlinkWeight(t - at));
  return face;
}

void TurnHead(const Script& script, float t, FramePose* pose) {
  for (const HeadMove& move : script.head) {
    const float share = Presence(move.start, move.onset, move.end, move.offset, t);
    pose->Turn("neck", 0.4f * share * move.down, 0.4f * share * move.left,
               -0.4f * share * move.lean);
    pose->Turn("head", 0.6f * share * move.down, 0.6f * share * move.left,
               -0.6f * share * move.lean);
  }
}

}  // namespace

std::vector<std::string> RecordingNames() {
  std::vector<std::string> names;
  for (const Script& script : Scripts()) names.push_back(script.name);
  return names;
}

Result<Recording> MakeRecording(std::string_view name, const wrinkle::Rig& rig,
                                const wrinkle::Skeleton& skeleton) {
  const auto script = std::find_if(Scripts().begin(), Scripts().end(),
                                   [&](const Script& s) { return s.name == name; });
  if (script == Scripts().end()) {
    return Status(StatusCode::kNotFound, "there is no recording '" + std::string(name) + "'");
  }
  Recording recording;
  recording.name = script->name;
  const int count = static_cast<int>(std::lround(script->seconds * kFramesPerSecond));
  for (int i = 0; i < count; ++i) {
    const float t = static_cast<float>(i) / kFramesPerSecond;
    FramePose pose(rig, skeleton);
    for (const PoseWeight& p : FaceAt(*script, t)) {
      FURROW_RETURN_IF_ERROR(pose.ApplyBoth(p.pose, p.left, p.right));
    }
    Stand(t, &pose);
    if (script->body == BodyMove::kWalk) Walk(t, &pose);
    if (script->body == BodyMove::kSquatAndReach) SquatAndReach(t, &pose);
    TurnHead(*script, t, &pose);
    recording.frames.push_back(pose.Take());
  }
  return recording;
}

}  // namespace furrow::authoring
