// SPDX-License-Identifier: Apache-2.0
#include "rig/shapes/arkit_shapes.h"

#include <string>

#include "base/ascii.h"

namespace furrow::rig {
namespace {

constexpr std::array<std::string_view, kNumArkitShapes> kArkitShapes = {
    "eyeBlinkLeft",      "eyeLookDownLeft",    "eyeLookInLeft",
    "eyeLookOutLeft",    "eyeLookUpLeft",      "eyeSquintLeft",
    "eyeWideLeft",       "eyeBlinkRight",      "eyeLookDownRight",
    "eyeLookInRight",    "eyeLookOutRight",    "eyeLookUpRight",
    "eyeSquintRight",    "eyeWideRight",       "jawForward",
    "jawLeft",           "jawRight",           "jawOpen",
    "mouthClose",        "mouthFunnel",        "mouthPucker",
    "mouthLeft",         "mouthRight",         "mouthSmileLeft",
    "mouthSmileRight",   "mouthFrownLeft",     "mouthFrownRight",
    "mouthDimpleLeft",   "mouthDimpleRight",   "mouthStretchLeft",
    "mouthStretchRight", "mouthRollLower",     "mouthRollUpper",
    "mouthShrugLower",   "mouthShrugUpper",    "mouthPressLeft",
    "mouthPressRight",   "mouthLowerDownLeft", "mouthLowerDownRight",
    "mouthUpperUpLeft",  "mouthUpperUpRight",  "browDownLeft",
    "browDownRight",     "browInnerUp",        "browOuterUpLeft",
    "browOuterUpRight",  "cheekPuff",          "cheekSquintLeft",
    "cheekSquintRight",  "noseSneerLeft",      "noseSneerRight",
    "tongueOut"};

}  // namespace

const std::array<std::string_view, kNumArkitShapes>& ArkitShapes() { return kArkitShapes; }

int FindArkitShape(std::string_view name) {
  for (int shape = 0; shape < kNumArkitShapes; ++shape) {
    if (EqualsIgnoreCase(kArkitShapes[static_cast<std::size_t>(shape)], name)) return shape;
  }
  return -1;
}

int MirroredArkitShape(int shape) {
  std::string name(kArkitShapes[static_cast<std::size_t>(shape)]);
  for (const auto& [from, to] : {std::pair<std::string_view, std::string_view>("Left", "Right"),
                                 std::pair<std::string_view, std::string_view>("Right", "Left")}) {
    if (!name.ends_with(from)) continue;
    name.replace(name.size() - from.size(), from.size(), to);
    break;
  }
  return FindArkitShape(name);
}

}  // namespace furrow::rig
