// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/recordings/body_moves.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <glm/common.hpp>

#include "authoring/generator/mesh/mesh_tools.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

// From the ankle of a standing foot to the ball and to the heel, metres.
constexpr vec3 kBall{0.0f, -0.063f, 0.135f};
constexpr vec3 kHeel{0.0f, -0.085f, -0.052f};
constexpr float kAnkleHeight = 0.085f;

constexpr float kCycle = 10.0f / 9.0f;  // seconds; nine cycles in a recording
constexpr float kStride = 1.15f;        // metres per cycle
constexpr float kStance = 0.61f;        // fraction of the cycle in which a foot stands
constexpr float kUnder = 0.27f;  // fraction of the cycle at which the hips pass over the foot

vec3 Pitched(const vec3& v, float degrees) {
  const float c = std::cos(degrees * kDegrees), s = std::sin(degrees * kDegrees);
  return {v.x, v.y * c - v.z * s, v.y * s + v.z * c};
}

struct FootPlace {
  float z;
  float y;
  float heel_up;  // degrees; negative: the heel touches and the toes are up
};

// The ankle of a foot that pivots on the floor about its ball or its heel.
FootPlace Pivoted(float planted, float heel_up) {
  const vec3 pivot = heel_up > 0.0f ? kBall : kHeel;
  const vec3 ankle = pivot - Pitched(pivot, heel_up);
  return {planted + ankle.z, kAnkleHeight + ankle.y, heel_up};
}

// The foot at `cycle`, counted from a strike of the foot. The integer part is the number of the
// step.
FootPlace WalkingFoot(float cycle, float offset) {
  const float step = std::floor(cycle);
  const float f = cycle - step;
  const float planted = kStride * (step + kUnder - offset);
  constexpr float kStrike = -17.0f, kOff = 48.0f;
  const auto standing = [&](float at) {
    const float strike = kStrike * Smoothstep(0.09f, 0.0f, at);
    return strike + kOff * std::pow(Smoothstep(0.36f, kStance + 0.09f, at), 1.2f);
  };
  if (f < kStance) return Pivoted(planted, standing(f));
  const float t = (f - kStance) / (1.0f - kStance);
  const FootPlace from = Pivoted(planted, standing(kStance));
  const FootPlace to = Pivoted(planted + kStride, kStrike);
  // The foot leaves the floor at its own speed and arrives slowly.
  const float ease = Smoothstep(0.0f, 1.0f, std::pow(t, 0.9f));
  const float lift = 0.055f * std::sin(kPi * t) * (1.0f - 0.5f * t);
  return {glm::mix(from.z, to.z, ease), glm::mix(from.y, to.y, Smoothstep(0.0f, 0.8f, t)) + lift,
          glm::mix(from.heel_up, to.heel_up, Smoothstep(0.0f, 0.85f, t))};
}

// A value at a time. Values are eased between keys and constant beyond them.
struct Key {
  float time;
  float value;
};

float Eased(std::span<const Key> keys, float t) {
  if (t <= keys.front().time) return keys.front().value;
  for (std::size_t i = 1; i < keys.size(); ++i) {
    if (t > keys[i].time) continue;
    const float ease = Smoothstep(keys[i - 1].time, keys[i].time, t);
    return glm::mix(keys[i - 1].value, keys[i].value, ease);
  }
  return keys.back().value;
}

}  // namespace

void Stand(float t, FramePose* pose) {
  const float breath = std::sin(2.0f * kPi * t / 4.1f);
  pose->TurnBoth("shoulder", 0, 0, -6.0f + 0.5f * breath);
  pose->TurnBoth("upper_arm", 0, 0, -70);
  pose->TurnBoth("lower_arm", 0, -15, 0);
  pose->TurnBoth("hand", 0, -4, 0);
  for (const float side : {1.0f, -1.0f}) pose->CloseHand(side, 0.06f);
  pose->Turn("chest", -0.6f * breath, 0, 0);
  const float nod = 1.3f * std::sin(0.9f * t) + 0.7f * std::sin(2.3f * t + 1.0f);
  const float shake = 2.2f * std::sin(0.61f * t + 0.4f) + 0.8f * std::sin(1.7f * t);
  const float tilt = 1.2f * std::sin(0.47f * t + 2.0f);
  pose->Turn("neck", 0.4f * nod, 0.4f * shake, 0.4f * tilt);
  pose->Turn("head", 0.6f * nod, 0.6f * shake, 0.6f * tilt);
}

void Walk(float t, FramePose* pose) {
  const float cycle = t / kCycle + 0.13f;  // starts in mid-step
  const float phase = 2.0f * kPi * cycle;
  // The hips are lowest while both feet stand and highest over either foot. They sway toward the
  // foot that stands.
  const float strike = std::cos(2.0f * (phase - 0.06f * 2.0f * kPi));
  pose->Move("hips", {0.020f * std::sin(phase), -0.034f - 0.013f * strike, kStride * cycle});
  pose->Turn("hips", 2.5f, -5.0f * std::cos(phase), 2.0f * std::sin(phase));
  pose->Turn("spine", 1.0f, 5.0f * std::cos(phase), -1.5f * std::sin(phase));
  pose->Turn("chest", 1.0f, 6.0f * std::cos(phase), -0.5f * std::sin(phase));
  pose->Turn("head", -3.0f, -4.0f * std::cos(phase), 0);
  for (const float side : {1.0f, -1.0f}) {
    const float offset = side > 0.0f ? 0.0f : 0.5f;
    const FootPlace foot = WalkingFoot(cycle + offset, offset);
    pose->PlantFoot(side, {side * 0.088f, foot.y, foot.z}, foot.heel_up, 6.0f);
    pose->Turn(side > 0.0f ? "toes_l" : "toes_r", -0.85f * std::max(foot.heel_up, 0.0f), 0, 0);
    // Each arm moves with the opposite leg. Elbows bend as they come forward.
    const float swing = std::cos(phase + 2.0f * kPi * offset - 0.15f);
    pose->Turn(side > 0.0f ? "upper_arm_l" : "upper_arm_r", 0, side * (22.0f * swing - 2.0f), 0);
    pose->Turn(side > 0.0f ? "lower_arm_l" : "lower_arm_r", 0, side * (-16.0f + 15.0f * swing), 0);
  }
}

void SquatAndReach(float t, FramePose* pose) {
  constexpr Key kDown[] = {{0.8f, 0.0f}, {2.3f, 1.0f}, {4.2f, 1.0f}, {5.6f, 0.0f}};
  constexpr Key kGrip[] = {{2.9f, 0.0f}, {3.5f, 0.85f}, {7.9f, 0.85f}, {8.4f, 0.0f}};
  constexpr Key kReach[] = {{1.0f, 0.0f}, {2.6f, 1.0f}, {4.2f, 1.0f}, {5.4f, 0.0f}};
  constexpr Key kUp[] = {{5.0f, 0.0f}, {6.4f, 1.0f}, {7.4f, 1.0f}, {8.4f, 0.0f}};
  constexpr Key kLean[] = {{8.4f, 0.0f},   {9.1f, 1.0f},   {9.5f, 1.0f},
                           {10.6f, -1.0f}, {11.0f, -1.0f}, {11.8f, 0.0f}};
  const float down = Eased(kDown, t), grip = Eased(kGrip, t), reach = Eased(kReach, t);
  const float up = Eased(kUp, t), lean = Eased(kLean, t);
  pose->Move("hips", {0.015f * lean, -0.47f * down, -0.19f * down});
  pose->Turn("hips", 24.0f * down - 3.0f * up, 4.0f * lean, 0);
  pose->Turn("spine", 20.0f * down - 5.0f * up, 16.0f * lean, -9.0f * lean);
  pose->Turn("chest", 14.0f * down - 5.0f * up, 14.0f * lean, -8.0f * lean);
  pose->Turn("neck", -10.0f * down - 8.0f * up, 10.0f * lean, 0);
  pose->Turn("head", -6.0f * down - 10.0f * up, 12.0f * lean, 0);
  for (const float side : {1.0f, -1.0f}) {
    pose->PlantFoot(side, {side * 0.118f, kAnkleHeight, -0.02f}, 0.0f, 12.0f);
    const std::string end = side > 0.0f ? "_l" : "_r";
    // The arm hangs along its own X: rotating about Y moves it forward, about Z outward.
    pose->Turn("shoulder" + end, 0, 0, side * 16.0f * up);
    pose->Turn("upper_arm" + end, 0, -side * (34.0f * reach + 20.0f * up), side * 112.0f * up);
    pose->Turn("lower_arm" + end, 0, -side * (12.0f * reach + 26.0f * up), 0);
    pose->CloseHand(side, grip);
  }
}

}  // namespace furrow::authoring
