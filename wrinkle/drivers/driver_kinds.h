// SPDX-License-Identifier: Apache-2.0
// The table of driver kinds. A kind is one folder and its rows in this table; nothing else has to
// change to read, write, check, solve and explain it.
//
// To add a kind "spread", write wrinkle/drivers/spread/ and add the kind to the four lists below:
// - spread.fbs: the schema of the kind's fields, with the comments that rig authors read. It has a
//   table SpreadDriver, and the tables and enumerations that SpreadDriver uses. The kinds share
//   one namespace. The build inserts the file into the rig's schema (rig/rig.fbs).
// - spread_fields.h: struct SpreadDriver, the kind's fields in a rig, with the constants
//   kMeasuresFromAnchor (true: it has a field `anchor`, and the rig's anchor counts where that is
//   empty) and kAddsJoints (true: its values are sums over the joints that it reads, so a chain of
//   joints can do the part of one), the list of its fields for the reader and the
//   writer of rig files, ListFields() (wrinkle/fields/field_list.h), and the functions
//   DriverValueNames(), CheckFields(), JointsRead(), JointsInfluenced() and FullPose(). A kind that
//   reads blend shapes also has BlendShapesRead().
// - spread_driver.h: class SpreadDriverSet, all bound drivers of the kind, with Bind(), Plan() and
//   Explain().
// - spread_lanes-inl.h: EvaluateDrivers(), compiled once per instruction set.
// drivers/twist/ is a short example.
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

// List 2: the kinds. KIND(Spread, spread) stands for SpreadDriver, for the field `spread` in code
// and in JSON, and for spread/spread.fbs. CMake reads this list too (cmake/RigSchema.cmake).
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
