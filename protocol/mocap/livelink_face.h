// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "protocol/mocap/adapter.h"

namespace furrow::protocol::mocap {

inline constexpr std::uint16_t kLiveLinkFacePort = 11111;
inline constexpr int kNumLiveLinkFaceShapes = 61;

// The 61 names in wire order, in Unreal's spelling ("EyeBlinkLeft" to "RightEyeRoll").
[[nodiscard]] std::span<const std::string_view> LiveLinkFaceShapeNames();

// Makes an adapter for Epic's Live Link Face app (ARKit mode, packet version 6). It takes the
// datagrams of several phones on one port.
//
// - A frame has no joints and 61 blend shapes. 52 are in [0, 1]; the nine of head and eyes are
//   small signed numbers. All are passed on unchanged.
// - A datagram without a face yields a frame with tracked = false and the last values.
// - The capture time follows from the sender's frame number, subframe and frame rate. A frame that
//   is not newer than the last one is dropped as reordered, unless it is more than 5 s older: then
//   the sender restarted or its clock passed midnight.
// - The timecode follows from these numbers, too (MakeTimecode()). A frame has none if its rate is
//   not one of timecodes, or if it is two days or more after midnight.
// - If two devices use one subject name, the first eight characters of the device id are appended
//   to the name of the later device. Above 16 devices, the one that was silent longest is dropped.
// - Malformed: another packet version, a string above 255 bytes, another count than 61, or a size
//   that does not match to the byte.
// Source: decoded from a capture of the app.
[[nodiscard]] std::unique_ptr<MocapAdapter> MakeLiveLinkFaceAdapter();

}  // namespace furrow::protocol::mocap
