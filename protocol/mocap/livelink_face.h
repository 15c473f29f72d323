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
// - A frame has no joints and the 61 blend shapes; 52 are in [0, 1], the nine of head and eyes are
//   small signed numbers, passed on as they are.
// - A datagram without a face gives a frame with tracked = false and the last values.
// - Capture time: the sender's frame number, subframe and rate. A frame not newer than the last is
//   dropped as reordered, unless it lies more than five seconds back: then the sender restarted, or
//   midnight passed.
// - Two devices that use one subject name are told apart by the first
//   eight characters of the device id after the name of the later one.
//   The one silent longest gives way when there are more than 16.
// - Other packet versions, strings above 255 bytes, other counts than 61, and sizes that do not fit
//   to the byte are malformed.
// Source: decoded from a capture of the app.
[[nodiscard]] std::unique_ptr<MocapAdapter> MakeLiveLinkFaceAdapter();

}  // namespace furrow::protocol::mocap
