// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "protocol/mocap/adapter.h"

namespace furrow::protocol::mocap {

inline constexpr std::uint16_t kLiveLinkFacePort = 11111;
inline constexpr int kNumLiveLinkFaceShapes = 61;

// The 61 names in the order of the wire, Unreal's spelling ("EyeBlinkLeft" .. "RightEyeRoll").
[[nodiscard]] std::span<const std::string_view> LiveLinkFaceShapeNames();

// Epic's Live Link Face (ARKit mode, packet version 6), several phones on one port.
//
// A frame has no joints and 61 blend shapes named as ARKit does ("eyeBlinkLeft"); 52 are in [0, 1],
// the nine of head and eyes are small signed numbers. A datagram without a face gives a frame with
// tracked = false and the last values. Capture time: frame number and rate of the sender.
// Subjects that fell silent give way when there are more than 16.
[[nodiscard]] std::unique_ptr<MocapAdapter> MakeLiveLinkFaceAdapter();

}  // namespace furrow::protocol::mocap
