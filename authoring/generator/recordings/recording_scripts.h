// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace furrow::authoring {

// A facial expression that appears, holds and fades. It plays on both sides; the right side follows
// 0.05 s later at 93% of the weight, since real expressions are asymmetric. Times in seconds.
struct Action {
  std::string pose;  // reference pose of the rig, without "_l" or "_r"
  float start;       // when it begins to appear
  float onset;       // how long it takes to appear
  float end;         // when it begins to fade
  float offset;      // how long it takes to fade
  float peak;        // weight while it holds
};

// A turn of the head that begins, holds and returns. The neck takes 40% of it, the head 60%.
struct HeadMove {
  float start;   // seconds, as in Action
  float onset;   // seconds
  float end;     // seconds
  float offset;  // seconds
  float down;    // degrees; negative: up
  float left;    // degrees, to the subject's left
  float lean;    // degrees, tilted to the subject's left shoulder
};

// The motion of the body below the head.
enum class BodyMove { kStand, kWalk, kSquatAndReach };

// The content of one recording.
struct Script {
  std::string name;
  float seconds = 10.0f;  // length
  std::vector<Action> actions;
  std::vector<HeadMove> head;
  std::vector<float> blinks;  // when each blink begins, seconds
  BodyMove body = BodyMove::kStand;
};

// The scripts of all recordings: four emotions as sets of FACS action units after EMFACS (happiness
// 6 + 12, anger 4 + 5 + 7 + 24, sadness 1 + 4 + 15 + 17, disgust 9 + 10 + 15 + 17), a performance
// of all four, a conversation, a walk and a squat. Made on the first call. Thread-safe.
[[nodiscard]] const std::vector<Script>& Scripts();

}  // namespace furrow::authoring
