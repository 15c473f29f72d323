// SPDX-License-Identifier: Apache-2.0
// The text that is written for each driver kind: the order of the fields, and which are omitted.
#include <string>

#include <gtest/gtest.h>

#include "rig/rig_file.h"

namespace furrow::rig {
namespace {

using wrinkle::Driver;

TEST(RigWriter, WritesAPoseDriver) {
  Driver driver{.name = "brow", .kind = Driver::Kind::kPose};
  driver.pose = {.points = {{.joint = "brow"},
                            {.joint = "lid",
                             .kind = wrinkle::ControlPoint::Kind::kOffset,
                             .offset = {0, 0.5f, 0},
                             .offset_size = 1.5f},
                            {.joint = "jaw", .kind = wrinkle::ControlPoint::Kind::kOrigin},
                            {.joint = "",
                             .kind = wrinkle::ControlPoint::Kind::kBlendShape,
                             .blend_shape = "browDownLeft"}},
                 .values = {{"stretch", "up"}, {"squash", "down"}}};
  EXPECT_EQ(DriverToJson(driver), R"({
  "name": "brow",
  "pose": {
    "points": [
      {"joint": "brow"},
      {"joint": "lid", "kind": "offset", "offset": [0, 0.5, 0], "offset_size": 1.5},
      {"joint": "jaw", "kind": "origin"},
      {"kind": "blend_shape", "blend_shape": "browDownLeft"}
    ],
    "values": [
      {"name": "stretch", "reference_pose": "up"},
      {"name": "squash", "reference_pose": "down"}
    ]
  }
}
)");
  driver.pose.points.resize(1);
  driver.pose.values.resize(1);
  driver.pose.anchor = "head";
  driver.pose.solve = wrinkle::PoseSolve::kNnls;
  driver.pose.falloff = 0.25f;
  EXPECT_EQ(DriverToJson(driver), R"({
  "name": "brow",
  "pose": {
    "points": [{"joint": "brow"}],
    "values": [{"name": "stretch", "reference_pose": "up"}],
    "anchor": "head",
    "solve": "nnls",
    "falloff": 0.25
  }
}
)");
}

TEST(RigWriter, WritesAHingeDriver) {
  Driver driver{.name = "knee", .kind = Driver::Kind::kHinge};
  driver.hinge = {.parent = "thigh", .joint = "shin"};
  EXPECT_EQ(DriverToJson(driver),
            "{\"name\": \"knee\", \"hinge\": {\"parent\": \"thigh\", \"joint\": \"shin\"}}\n");
  driver.hinge.end = "foot";
  driver.hinge.bone = glm::vec3(0, -1, 0.25f);
  driver.hinge.axis = glm::vec3(0);
  driver.hinge.beta_degrees = 40.5f;
  EXPECT_EQ(DriverToJson(driver), R"({
  "name": "knee",
  "hinge": {
    "parent": "thigh",
    "joint": "shin",
    "end": "foot",
    "bone": [0, -1, 0.25],
    "axis": [0, 0, 0],
    "beta_degrees": 40.5
  }
}
)");
}

TEST(RigWriter, WritesABallDriver) {
  Driver driver{.name = "hip", .kind = Driver::Kind::kBall};
  driver.ball = {.parent = "pelvis", .joint = "thigh"};
  EXPECT_EQ(DriverToJson(driver),
            "{\"name\": \"hip\", \"ball\": {\"parent\": \"pelvis\", \"joint\": \"thigh\"}}\n");
  driver.ball.end = "shin";
  driver.ball.bone = {0, -1, 0};
  driver.ball.forward = {0, 0, 0};
  driver.ball.beta_degrees = 0.0f;
  driver.ball.mode = wrinkle::BallMode::kThesis;
  driver.ball.back = {.threshold_degrees = 10.0f, .limit_degrees = 60.0f};
  EXPECT_EQ(DriverToJson(driver), R"({
  "name": "hip",
  "ball": {
    "parent": "pelvis",
    "joint": "thigh",
    "end": "shin",
    "bone": [0, -1, 0],
    "forward": [0, 0, 0],
    "beta_degrees": 0,
    "mode": "thesis",
    "back": {"threshold_degrees": 10, "limit_degrees": 60}
  }
}
)");
}

TEST(RigWriter, WritesATwistDriver) {
  Driver driver{.name = "neck", .kind = Driver::Kind::kTwist};
  driver.twist = {.joint = "neck"};
  EXPECT_EQ(DriverToJson(driver), "{\"name\": \"neck\", \"twist\": {\"joint\": \"neck\"}}\n");
  driver.twist.axis = glm::vec3(0, 1, 0);
  driver.twist.full_degrees = 60.0f;
  driver.twist.through = {"neck_2", "neck_3"};
  EXPECT_EQ(DriverToJson(driver), R"({
  "name": "neck",
  "twist": {"joint": "neck", "axis": [0, 1, 0], "full_degrees": 60, "through": ["neck_2", "neck_3"]}
}
)");
}

TEST(RigWriter, WritesABlendShapeDriver) {
  Driver driver{.name = "jaw", .kind = Driver::Kind::kBlendShape};
  driver.blend_shape = {.blend_shape = "jawOpen"};
  EXPECT_EQ(DriverToJson(driver),
            "{\"name\": \"jaw\", \"blend_shape\": {\"blend_shape\": \"jawOpen\"}}\n");
  driver.blend_shape.neutral = 1.0f;
  driver.blend_shape.full = 0.0f;
  EXPECT_EQ(DriverToJson(driver),
            "{\"name\": \"jaw\", \"blend_shape\": {\"blend_shape\": \"jawOpen\", \"neutral\": 1, "
            "\"full\": 0}}\n");
}

TEST(RigWriter, WritesAStrainDriver) {
  Driver driver{.name = "cheek", .kind = Driver::Kind::kStrain};
  driver.strain = {.joint = "head",
                   .joints = {"head", "jaw"},
                   .vertices = {{{0, 0, 0}, {0}, {1.0f}}, {{1, 0, 0}, {0, 1}, {0.25f, 0.75f}}},
                   .triangles = {0, 1, 2}};
  EXPECT_EQ(DriverToJson(driver), R"({
  "name": "cheek",
  "strain": {
    "joint": "head",
    "direction": [1, 0, 0],
    "joints": ["head", "jaw"],
    "vertices": [
      {"position": [0, 0, 0], "joints": [0], "skin_weights": [1]},
      {"position": [1, 0, 0], "joints": [0, 1], "skin_weights": [0.25, 0.75]}
    ],
    "triangles": [0, 1, 2]
  }
}
)");
  driver.strain.vertices.resize(1);
  driver.strain.shapes = {{"puff", {0}, {0.5f, 0, -1}}};
  driver.strain.full_compression = 0.5f;
  driver.strain.size = 1.7f;
  EXPECT_EQ(DriverToJson(driver), R"({
  "name": "cheek",
  "strain": {
    "joint": "head",
    "direction": [1, 0, 0],
    "full_compression": 0.5,
    "size": 1.7,
    "joints": ["head", "jaw"],
    "vertices": [{"position": [0, 0, 0], "joints": [0], "skin_weights": [1]}],
    "triangles": [0, 1, 2],
    "shapes": [{"blend_shape": "puff", "vertices": [0], "deltas": [0.5, 0, -1]}]
  }
}
)");
}

}  // namespace
}  // namespace furrow::rig
