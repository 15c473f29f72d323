// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "protocol/mocap/adapter.h"

namespace furrow::protocol::mocap {

inline constexpr std::uint16_t kVmcPort = 39539;

struct VmcOptions {
  std::string subject = "vmc";       // the protocol does not name the subject
  std::int64_t timeout_us = 50'000;  // a frame without an end mark ends this long after it began
};

// Makes an adapter for the Virtual Motion Capture Protocol 3.1 in the role of a Marionette (the
// receiver of a pose). It converts OSC messages, bare or in bundles, to frames of one sender.
//
// - A frame ends with /VMC/Ext/T if the sender sent one within the last second, otherwise with
//   /VMC/Ext/Blend/Apply, otherwise when a joint repeats, otherwise after `timeout_us`.
// - The 55 humanoid joints have the hierarchy of Unity's HumanBodyBones. If the sender never sent
//   the parent of a joint, the nearest ancestor that it did send becomes the parent. Joints with
//   other names become children of Hips. The joint "Root" carries /VMC/Ext/Root/Pos. Locomotion may
//   be in Root, in Hips or in both.
// - Many senders send zero for all translations except those of Root and Hips. Such joints get the
//   offsets of an average adult, because drivers need limbs with a length. The first non-zero
//   translation of a joint becomes its rest translation.
// - Blend-shape names are case-insensitive. A blend shape that is not sent keeps its value.
// - A new avatar (/VMC/Ext/VRM) discards all joints and blend shapes.
// - Frames are dropped as stale while /VMC/Ext/OK reports loaded = 0.
// Space: Unity's left-handed axes (Y up, Z forward) are mirrored by M = (-x, y, z), determinant -1.
// Positions become (-x, y, z) and quaternions (x, -y, -z, w).
// Source: sh-akira/VirtualMotionCaptureProtocol.
[[nodiscard]] std::unique_ptr<MocapAdapter> MakeVmcAdapter(const VmcOptions& options = {});

}  // namespace furrow::protocol::mocap
