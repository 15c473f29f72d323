// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/recordings/recording_scripts.h"

#include "authoring/generator/mesh/mesh_tools.h"
#include "authoring/paint/noise.h"

namespace furrow::authoring {
namespace {

Script Happiness() {
  Script s{"happiness"};
  s.actions = {{"lip_corner_pull", 1.1f, 0.6f, 7.2f, 1.1f, 1.0f},
               {"cheek_raise", 1.3f, 0.6f, 7.0f, 0.9f, 0.9f},
               {"lid_raise", 1.4f, 0.5f, 6.9f, 0.8f, 0.2f},
               {"upper_lip_raise", 1.4f, 0.6f, 6.6f, 0.8f, 0.4f},
               {"jaw_open", 1.5f, 0.7f, 6.2f, 1.0f, 0.11f},
               {"brow_raise_outer", 1.9f, 0.5f, 4.6f, 0.8f, 0.35f}};
  s.head = {{1.3f, 0.7f, 7.0f, 1.2f, -4.0f, 2.0f, -5.0f},
            {3.1f, 0.3f, 3.5f, 0.5f, 4.0f, 0.0f, 0.0f}};
  s.blinks = {0.6f, 3.9f, 6.2f, 8.6f};
  return s;
}

Script Anger() {
  Script s{"anger"};
  s.actions = {
      {"brow_lower", 1.1f, 0.4f, 7.6f, 0.9f, 1.0f},   {"lid_raise", 1.3f, 0.35f, 7.2f, 0.6f, 0.45f},
      {"lid_tighten", 2.2f, 0.4f, 7.0f, 0.6f, 0.35f}, {"lip_press", 1.4f, 0.45f, 7.3f, 0.8f, 1.0f},
      {"lip_stretch", 1.5f, 0.5f, 7.1f, 0.8f, 0.15f}, {"jawForward", 1.6f, 0.5f, 7.2f, 0.9f, 0.3f},
      {"look_up", 1.5f, 0.5f, 7.2f, 0.8f, 0.6f}};  // from under the brows
  s.head = {{1.3f, 0.6f, 7.2f, 1.0f, 8.0f, 0.0f, 0.0f},
            {3.4f, 0.25f, 5.6f, 0.8f, 1.0f, 0.0f, 2.0f}};
  s.blinks = {0.5f, 6.3f, 8.8f};  // anger stares
  return s;
}

Script Sadness() {
  Script s{"sadness"};
  s.actions = {{"brow_raise_inner", 1.1f, 0.6f, 7.6f, 1.3f, 1.0f},
               {"brow_lower", 1.4f, 0.6f, 7.4f, 1.2f, 0.25f},
               {"lip_corner_down", 1.4f, 0.6f, 7.6f, 1.3f, 1.0f},
               {"chin_raise", 2.2f, 0.6f, 7.0f, 1.1f, 0.8f},
               {"blink", 2.0f, 0.8f, 7.2f, 1.0f, 0.16f},  // heavy lids
               {"look_down", 2.6f, 0.7f, 6.8f, 0.9f, 0.4f}};
  s.head = {{1.8f, 1.2f, 7.2f, 1.4f, 8.0f, -3.0f, 6.0f}};
  s.blinks = {0.7f, 3.2f, 6.4f, 8.9f};
  return s;
}

Script Disgust() {
  Script s{"disgust"};
  s.actions = {{"nose_wrinkle", 1.1f, 0.4f, 6.9f, 1.0f, 1.0f},
               // One side more than the other.
               {"upper_lip_raise_l", 1.2f, 0.45f, 6.8f, 1.0f, 0.85f},
               {"upper_lip_raise_r", 1.2f, 0.45f, 6.8f, 1.0f, 0.5f},
               {"brow_lower", 1.25f, 0.45f, 6.6f, 0.9f, 0.35f},
               {"lid_tighten", 1.4f, 0.5f, 6.6f, 0.9f, 0.75f},
               {"cheek_raise", 1.4f, 0.5f, 6.6f, 0.9f, 0.5f},
               {"lip_corner_down", 1.7f, 0.5f, 6.8f, 1.0f, 0.35f},
               {"chin_raise", 2.0f, 0.5f, 6.2f, 0.9f, 0.6f},
               {"look_left", 2.4f, 0.5f, 6.4f, 0.5f, 0.3f}};  // back at what it turns from
  s.head = {{1.3f, 0.5f, 6.7f, 1.0f, -6.0f, -12.0f, -5.0f}};
  s.blinks = {0.5f, 4.2f, 8.2f};
  return s;
}

Script Performance() {
  Script s{"performance", 12.0f};
  s.actions = {// Surprise: brows up, jaw drops.
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
               {"chin_raise", 9.8f, 0.5f, 10.8f, 0.7f, 0.8f}};
  s.blinks = {0.3f, 2.4f, 5.0f, 7.1f, 9.2f, 11.7f};
  return s;
}

// Syllables from `start` to `end`, five or so a second: mouths open, widen, round and close in an
// order that looks like talk.
void Speak(float start, float end, int seed, std::vector<Action>* actions) {
  int i = 0;
  for (float t = start; t < end - 0.2f; ++i) {
    const float beat = 0.15f + 0.11f * RandomAt(seed, i, 1);
    const float loud = 0.55f + 0.45f * RandomAt(seed, i, 2);
    const float kind = RandomAt(seed, i, 3);
    const auto mouth = [&](const char* pose, float peak) {
      actions->push_back({pose, t, 0.12f, t + 0.6f * beat, 0.15f, peak * loud});
    };
    if (kind < 0.40f) {  // a, e: open
      mouth("jaw_open", 0.42f);
      mouth("upper_lip_raise", 0.16f);
    } else if (kind < 0.62f) {  // i, s: wide
      mouth("lip_stretch", 0.30f);
      mouth("jaw_open", 0.16f);
    } else if (kind < 0.82f) {  // o, u, w: round
      mouth("lip_pucker", 0.50f);
      mouth("jaw_open", 0.20f);
    } else {  // m, b, p: closed
      mouth("lip_press", 0.55f);
    }
    t += beat;
  }
}

Script Conversation() {
  Script s{"conversation", 20.0f};
  s.actions = {// Listening, a polite smile; then speech with brows that mark what matters.
               {"lip_corner_pull", 0.9f, 0.5f, 2.2f, 0.7f, 0.45f},
               {"cheek_raise", 1.0f, 0.5f, 2.1f, 0.6f, 0.30f},
               {"brow_raise_inner", 3.0f, 0.25f, 3.6f, 0.4f, 0.55f},
               {"brow_raise_outer", 3.0f, 0.25f, 3.6f, 0.4f, 0.70f},
               {"brow_lower", 5.2f, 0.4f, 6.6f, 0.6f, 0.50f},
               {"lid_tighten", 5.3f, 0.4f, 6.5f, 0.5f, 0.35f},
               // Puzzled by the other's words, one brow more than the other.
               {"brow_lower_r", 8.2f, 0.4f, 10.0f, 0.5f, 0.60f},
               {"brow_raise_outer_l", 8.3f, 0.4f, 10.0f, 0.5f, 0.80f},
               {"lip_press", 8.6f, 0.4f, 9.8f, 0.5f, 0.50f},
               {"look_right", 8.9f, 0.2f, 9.6f, 0.2f, 0.40f},
               // Explains, doubts, is amused.
               {"brow_raise_inner", 11.6f, 0.3f, 12.5f, 0.4f, 0.80f},
               {"look_up", 11.2f, 0.2f, 11.9f, 0.2f, 0.35f},
               {"nose_wrinkle", 14.1f, 0.3f, 14.9f, 0.5f, 0.45f},
               {"lip_corner_down", 14.2f, 0.3f, 14.9f, 0.5f, 0.50f},
               {"lip_corner_pull", 16.2f, 0.5f, 18.4f, 0.9f, 1.00f},
               {"cheek_raise", 16.4f, 0.5f, 18.2f, 0.8f, 0.85f},
               {"jaw_open", 16.8f, 0.3f, 17.6f, 0.5f, 0.30f}};
  Speak(2.6f, 7.6f, 61, &s.actions);
  Speak(10.4f, 15.8f, 62, &s.actions);
  s.head = {
      {1.0f, 0.4f, 1.4f, 0.5f, 5.0f, 0.0f, 0.0f},  // a nod
      {3.0f, 0.3f, 4.4f, 0.6f, -3.0f, 4.0f, 0.0f},   {5.0f, 0.4f, 6.8f, 0.7f, 4.0f, -5.0f, 0.0f},
      {8.2f, 0.5f, 10.0f, 0.6f, 0.0f, 3.0f, -7.0f},  // puzzled
      {11.2f, 0.4f, 12.6f, 0.6f, -5.0f, 5.0f, 2.0f}, {13.9f, 0.3f, 14.9f, 0.5f, 2.0f, -8.0f, 3.0f},
      {16.4f, 0.5f, 18.4f, 0.8f, -4.0f, 0.0f, 5.0f}};
  s.blinks = {0.4f, 2.5f, 4.9f, 7.8f, 10.2f, 12.9f, 15.9f, 19.0f};
  return s;
}

Script Moving(const char* name, float seconds, BodyMove body, std::vector<float> blinks) {
  Script s{name, seconds};
  s.body = body;
  s.blinks = std::move(blinks);
  return s;
}

}  // namespace

const std::vector<Script>& Scripts() {
  static const std::vector<Script> scripts = {
      Happiness(),
      Anger(),
      Sadness(),
      Disgust(),
      Performance(),
      Conversation(),
      Moving("walk", 10.0f, BodyMove::kWalk, {0.9f, 4.4f, 8.0f}),
      Moving("squat", 12.0f, BodyMove::kSquatAndReach, {1.0f, 4.6f, 8.3f, 11.2f})};
  return scripts;
}

}  // namespace furrow::authoring
