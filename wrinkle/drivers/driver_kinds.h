// SPDX-License-Identifier: Apache-2.0
// The table of driver kinds: the only file outside the kinds' folders that names them in wrinkle/.
//
// To add a kind "spread", write wrinkle/drivers/spread/ and add the kind to the four lists below:
// - spread_fields.h: struct SpreadDriver, the kind's fields in a rig, with the constants
//   kReadsJoints and kMeasuresFromAnchor, and the functions DriverValueNames(), CheckFields(),
//   JointsRead(), JointsInfluenced() and FullPose().
// - spread_driver.h: class SpreadDriverSet, all bound drivers of the kind, with Bind(), Plan() and
//   Explain().
// - spread_lanes-inl.h: EvaluateDrivers(), compiled once per instruction set.
// drivers/twist/ is a short example. rig/drivers/ reads and writes the kind's JSON.
//
// This file may be included several times. It always defines the fields and the list. The bound
// drivers follow if FURROW_BOUND_DRIVERS is defined, and the SIMD code if FURROW_DRIVER_LANES is.
// That keeps the heavy parts out of rig.h.
#ifndef FURROW_WRINKLE_DRIVERS_DRIVER_KINDS_H_
#define FURROW_WRINKLE_DRIVERS_DRIVER_KINDS_H_

// List 1: the fields.
#include "wrinkle/drivers/ball/ball_fields.h"
#include "wrinkle/drivers/blend_shape/blend_shape_fields.h"
#include "wrinkle/drivers/hinge/hinge_fields.h"
#include "wrinkle/drivers/pose/pose_fields.h"
#include "wrinkle/drivers/strain/strain_fields.h"
#include "wrinkle/drivers/twist/twist_fields.h"

// List 2: the kinds. KIND(Spread, spread) stands for SpreadDriver and for the field `spread` in
// code and in JSON.
#define FURROW_DRIVER_KINDS(KIND) \
  KIND(Pose, pose)                \
  KIND(Hinge, hinge)              \
  KIND(Ball, ball)                \
  KIND(Twist, twist)              \
  KIND(BlendShape, blend_shape)   \
  KIND(Strain, strain)

#endif  // FURROW_WRINKLE_DRIVERS_DRIVER_KINDS_H_

#ifdef FURROW_BOUND_DRIVERS
// List 3: the bound drivers.
#include "wrinkle/drivers/ball/ball_driver.h"
#include "wrinkle/drivers/blend_shape/blend_shape_driver.h"
#include "wrinkle/drivers/hinge/hinge_driver.h"
#include "wrinkle/drivers/pose/pose_driver.h"
#include "wrinkle/drivers/strain/strain_driver.h"
#include "wrinkle/drivers/twist/twist_driver.h"
#undef FURROW_BOUND_DRIVERS
#endif

#ifdef FURROW_DRIVER_LANES
// List 4: the evaluation in lanes.
#include "wrinkle/drivers/ball/ball_lanes-inl.h"
#include "wrinkle/drivers/blend_shape/blend_shape_lanes-inl.h"
#include "wrinkle/drivers/hinge/hinge_lanes-inl.h"
#include "wrinkle/drivers/pose/pose_lanes-inl.h"
#include "wrinkle/drivers/strain/strain_lanes-inl.h"
#include "wrinkle/drivers/twist/twist_lanes-inl.h"
#undef FURROW_DRIVER_LANES
#endif
