// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "protocol/mocap/adapter.h"

namespace furrow::protocol::mocap {

inline constexpr std::uint16_t kVmcPort = 39539;

struct VmcOptions {
  std::string subject = "vmc";       // the wire names nobody
  std::int64_t timeout_us = 50'000;  // a frame without a mark of its end is given out after this
};

// Virtual Motion Capture Protocol 3.1 as a Marionette: OSC messages, bare or in bundles, to frames.
//
// - End of a frame: /VMC/Ext/T where the sender has sent one within a second, else Blend/Apply,
//   else the second time a joint comes, else `timeout_us`.
// - Joints are the 55 humanoid ones under the hierarchy of Unity's HumanBodyBones (a joint whose
//   usual parent was never sent hangs on the nearest ancestor that was); other names hang on Hips.
//   The root joint "Root" carries /VMC/Ext/Root/Pos; motion may be in it, in Hips, or in both.
// - Many senders give zero for all translations but those of Root and Hips: such joints stand at
//   the distances of an average adult, so that drivers find limbs of some length. The first
//   translation that is not zero becomes the joint's rest translation.
// - Blend-shape names match whatever their case; shapes not sent keep their value.
// - Another avatar (/VMC/Ext/VRM) begins with nothing known: what the last one had is forgotten.
// - While /VMC/Ext/OK says loaded = 0, frames are dropped as stale.
// Space: Unity's (left-handed, Y up, Z forward) by M = (-x, y, z), determinant -1: positions
// (-x, y, z), quaternions (x, -y, -z, w).
// Source: sh-akira/VirtualMotionCaptureProtocol.
[[nodiscard]] std::unique_ptr<MocapAdapter> MakeVmcAdapter(const VmcOptions& options = {});

}  // namespace furrow::protocol::mocap
