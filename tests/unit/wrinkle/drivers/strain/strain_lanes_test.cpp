// SPDX-License-Identifier: Apache-2.0
// Strain drivers in lanes against the evaluation of one vertex after the other, to the bit, with
// every instruction set of this processor.
#include <algorithm>
#include <array>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/wrinkle/bound_rig.h"
#include "tests/unit/wrinkle/crowd.h"
#include "tests/unit/wrinkle/instruction_sets.h"
#include "wrinkle/solver/binding_data.h"

namespace furrow::wrinkle {
namespace {

float Uniform(std::mt19937* random, float from, float to) {
  return std::uniform_real_distribution<float>(from, to)(*random);
}

// A sheet of width x height vertices on the cheek. Each vertex follows one to four joints in random
// order, some of them with the skin weight 0. Two blend shapes move every second vertex.
Driver RandomPatch(const std::string& name, int width, int height, std::mt19937* random) {
  Driver driver;
  driver.name = name;
  driver.kind = Driver::Kind::kStrain;
  StrainDriver& strain = driver.strain;
  strain.joint = "head";
  strain.joints = {"head", "cheek_l", "brow_l", "brow_r"};
  strain.direction = {0.0f, 1.0f, 0.0f};
  strain.full_compression = 1.0f;  // so that few values are clamped
  strain.shapes = {{.blend_shape = "puff"}, {.blend_shape = "slide"}};
  for (int i = 0; i < width * height; ++i) {
    StrainDriver::Vertex& vertex = strain.vertices.emplace_back();
    const auto x = static_cast<float>(i % width);
    const auto y = static_cast<float>(i / width);
    vertex.position = glm::vec3(0.02f + 0.01f * x, 0.02f + 0.01f * y, 0.08f - 0.003f * x * y) +
                      RandomVector(random, 0.002f);
    vertex.joints = {0, 1, 2, 3};
    std::shuffle(vertex.joints.begin(), vertex.joints.end(), *random);
    vertex.joints.resize(1 + static_cast<std::size_t>(i) % 4);
    float sum = 0.0f;
    for (std::size_t k = 0; k < vertex.joints.size(); ++k) {
      const bool is_zero = k > 0 && (i + static_cast<int>(k)) % 3 == 0;
      vertex.skin_weights.push_back(is_zero ? 0.0f : Uniform(random, 0.1f, 1.0f));
      sum += vertex.skin_weights.back();
    }
    for (float& skin_weight : vertex.skin_weights) skin_weight /= sum;
    if (i % 2 == 0) continue;
    StrainDriver::Shape& shape = strain.shapes[static_cast<std::size_t>(i / 2 % 2)];
    shape.vertices.push_back(i);
    for (int axis = 0; axis < 3; ++axis) shape.deltas.push_back(Uniform(random, -0.001f, 0.001f));
  }
  for (int i = 0; i < (height - 1) * width; ++i) {
    if (i % width == width - 1) continue;
    for (const int k : {0, 1, width, 1, width + 1, width}) strain.triangles.push_back(i + k);
  }
  return driver;
}

// All values of a rig of strain drivers, without lanes.
std::vector<float> ValuesWithoutLanes(const RigBinding& binding, const LocalPose& pose) {
  const BindingData& data = binding.data();
  const StrainDriverSet& drivers = data.drivers.strain;
  std::vector<float> values(data.driver_value_names.size());
  for (int i = 0; i < drivers.num_entries(); ++i) {
    const auto frames = drivers.Frames(i, pose.joints, data.chains);
    drivers.EvaluateFrames(i, frames, pose.blend_shapes,
                           std::span(values).subspan(drivers.first_value(i), 4));
  }
  return values;
}

class StrainLanesTest : public InstructionSetTest {};
FURROW_FOR_INSTRUCTION_SETS(StrainLanesTest);

TEST_P(StrainLanesTest, HaveTheBitsOfOneVertexAfterTheOther) {
  std::mt19937 random(91);
  Rig rig;
  // 4 to 256 vertices: parts of a row, whole rows, and corners from many rows.
  for (const auto& [width, height] :
       {std::array{2, 2}, {3, 3}, {4, 4}, {17, 2}, {6, 7}, {16, 16}}) {
    const std::string name = std::to_string(width) + "x" + std::to_string(height);
    rig.drivers.push_back(RandomPatch(name, width, height, &random));
    rig.drivers.push_back(RandomPatch(name + "_joints", width, height, &random));
    rig.drivers.back().strain.shapes.clear();
  }
  BoundRig bound(rig, MakeBody(5), {"slide", "puff"});
  std::size_t num_compressed = 0;
  for (int round = 0; round < 100; ++round) {
    LocalPose pose = RestPose(bound.skeleton());
    for (const char* joint : {"cheek_l", "brow_l", "brow_r"}) {
      Move(bound.skeleton(), joint, RandomVector(&random, 0.002f), &pose);
      Turn(bound.skeleton(), joint,
           glm::slerp(glm::quat(1, 0, 0, 0), RandomRotation(&random), 0.02f), &pose);
    }
    if (round % 3 == 0) pose.joints[2].scale = {1.1f, 0.9f, 1.0f};
    pose.blend_shapes = {Uniform(&random, -1.0f, 1.0f), Uniform(&random, -1.0f, 1.0f)};
    pose.blend_shapes.resize(static_cast<std::size_t>(round % 3));
    bound.Solve(pose);
    const std::vector<float> expected = ValuesWithoutLanes(*bound.binding(), pose);
    ASSERT_TRUE(SameBits(bound.values(), expected)) << round;
    num_compressed += static_cast<std::size_t>(
        std::ranges::count_if(expected, [](float value) { return value > 0.0f && value < 1.0f; }));
  }
  EXPECT_GT(num_compressed, 500u);
}

// Joints that the skeleton lacks rest on the base joint.
TEST_P(StrainLanesTest, MissingJointsRest) {
  std::mt19937 random(92);
  Rig rig;
  rig.drivers = {RandomPatch("patch", 6, 7, &random)};
  rig.drivers[0].strain.joints[2] = "jowl";
  auto binding = RigBinding::Create(rig, MakeBody(5), std::vector<std::string>{"puff"},
                                    {.allow_missing = true});
  ASSERT_TRUE(binding.ok()) << binding.status().ToString();
  const auto shared = std::make_shared<const RigBinding>(*std::move(binding));
  LocalPose pose = RestPose(shared->skeleton());
  for (int round = 0; round < 20; ++round) {
    Move(shared->skeleton(), "cheek_l", RandomVector(&random, 0.002f), &pose);
    pose.blend_shapes = {Uniform(&random, -1.0f, 1.0f)};
    SubjectSolver solver(shared, false);
    ASSERT_EQ(solver.Update(pose, 0.0), JobStatus::kOk);
    ASSERT_TRUE(SameBits(solver.driver_values(), ValuesWithoutLanes(*shared, pose))) << round;
  }
}

}  // namespace
}  // namespace furrow::wrinkle
