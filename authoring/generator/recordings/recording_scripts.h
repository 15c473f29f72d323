// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace furrow::authoring {

// A reference pose that comes, stays and goes: seconds; `pose` without side means both sides, the
// right one a little later and a little less, as faces do.
struct Action {
  std::string pose;
  float start;
  float onset;
  float end;  // when it begins to go
  float offset;
  float peak;
};

// A turn of the head that comes, stays and goes; neck and head share it. Degrees: down, to the
// subject's left, and leaning to the subject's left.
struct HeadMove {
  float start;
  float onset;
  float end;
  float offset;
  float down;
  float left;
  float lean;
};

enum class BodyMove { kStand, kWalk, kSquatAndReach };

struct Script {
  std::string name;
  float seconds = 10.0f;
  std::vector<Action> actions;
  std::vector<HeadMove> head;
  std::vector<float> blinks;  // seconds
  BodyMove body = BodyMove::kStand;
};

// Emotions after EMFACS (happiness 6 + 12, anger 4 + 5 + 7 + 24, sadness 1 + 4 + 15 + 17, disgust
// 9 + 10 + 15 + 17), a talk, a performance of all, a walk, a squat. Made once.
[[nodiscard]] const std::vector<Script>& Scripts();

}  // namespace furrow::authoring
