// SPDX-License-Identifier: Apache-2.0
#include "bench/render/thesis_body.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include "tests/unit/render/character_parts.h"
#include "tests/unit/render/test_character.h"

namespace furrow::bench {
namespace {

using character::Character;
using character::Material;
using character::Mesh;
using character::Vertex;

constexpr float kTwoPi = glm::two_pi<float>();

// A part of the body: a tube that tapers towards its ends, with a chain of joints along its axis.
struct Tube {
  const char* name;
  glm::vec3 start;
  glm::vec3 end;
  float radius;
  std::uint32_t columns;
  std::uint32_t rows;
  int joints;
};

constexpr std::array<Tube, 6> kTubes = {{
    {"trunk", {0.0f, 0.0f, 0.0f}, {0.0f, 0.60f, 0.0f}, 0.17f, 40, 50, 31},
    {"neck", {0.0f, 0.61f, 0.0f}, {0.0f, 0.90f, 0.0f}, 0.09f, 25, 25, 21},
    {"leg_l", {0.10f, -0.02f, 0.0f}, {0.13f, -0.92f, 0.0f}, 0.09f, 16, 30, 26},
    {"leg_r", {-0.10f, -0.02f, 0.0f}, {-0.13f, -0.92f, 0.0f}, 0.09f, 16, 30, 26},
    {"arm_l", {0.18f, 0.54f, 0.0f}, {0.52f, 0.05f, 0.0f}, 0.06f, 10, 28, 26},
    {"arm_r", {-0.18f, 0.54f, 0.0f}, {-0.52f, 0.05f, 0.0f}, 0.06f, 10, 28, 26},
}};

constexpr int NumTriangles() {
  std::uint32_t quads = 0;
  for (const Tube& tube : kTubes) quads += tube.columns * tube.rows;
  return static_cast<int>(2 * quads);
}
static_assert(NumTriangles() == kBodyTriangles);

constexpr int kNumBendingJoints = 150;  // all joints but the first of each chain

// The texture atlas has one cell per tube.
constexpr std::size_t kAtlasColumns = 3;
constexpr std::size_t kAtlasRows = 2;
static_assert(kAtlasColumns * kAtlasRows == kTubes.size());
constexpr float kGutter = 0.02f;  // fraction of a cell

glm::vec2 InAtlas(std::size_t tube, float around, float along) {
  const glm::vec2 cell(tube % kAtlasColumns, tube / kAtlasColumns);
  const glm::vec2 within =
      glm::mix(glm::vec2(kGutter), glm::vec2(1.0f - kGutter), glm::vec2(around, along));
  return (cell + within) / glm::vec2(kAtlasColumns, kAtlasRows);
}

std::string JointName(const Tube& tube, int joint) {
  return std::string(tube.name) + std::to_string(joint);
}

Vertex TubeVertex(std::size_t index, int first_joint, float around, float along) {
  const Tube& tube = kTubes[index];
  const glm::vec3 axis = glm::normalize(tube.end - tube.start);
  const glm::vec3 side = glm::normalize(glm::cross(axis, glm::vec3(0.0f, 0.0f, 1.0f)));
  const glm::vec3 front = glm::cross(side, axis);
  const float angle = kTwoPi * around;
  const glm::vec3 outwards = std::cos(angle) * side + std::sin(angle) * front;
  const float taper = std::sqrt(std::max(0.0f, 1.0f - std::pow(2.0f * along - 1.0f, 8.0f)));
  Vertex vertex;
  vertex.position = glm::mix(tube.start, tube.end, along) + tube.radius * taper * outwards;
  vertex.normal = outwards;
  vertex.tangent = glm::vec4(-std::sin(angle) * side + std::cos(angle) * front, 1.0f);
  vertex.uv = InAtlas(index, around, along);
  const float place = along * static_cast<float>(tube.joints - 1);
  const int joint = std::min(static_cast<int>(place), tube.joints - 2);
  vertex.joints[0] = static_cast<std::uint16_t>(first_joint + joint);
  vertex.joints[1] = static_cast<std::uint16_t>(first_joint + joint + 1);
  vertex.skin_weights[1] = place - static_cast<float>(joint);
  vertex.skin_weights[0] = 1.0f - vertex.skin_weights[1];
  return vertex;
}

void AddTube(std::size_t index, int first_joint, Mesh* mesh) {
  const auto vertex = [&](float u, float v) { return TubeVertex(index, first_joint, u, v); };
  render::test::AddGrid(kTubes[index].columns, kTubes[index].rows, vertex, mesh);
}

// The root, then the chain of each tube. Skin weights refer to positions in this list.
std::vector<wrinkle::JointDesc> Joints() {
  std::vector<wrinkle::JointDesc> joints(1);
  joints[0].name = "root";
  joints[0].rest.translation = {0.0f, -0.1f, 0.0f};
  for (const Tube& tube : kTubes) {
    const glm::vec3 step = (tube.end - tube.start) / static_cast<float>(tube.joints - 1);
    for (int i = 0; i < tube.joints; ++i) {
      wrinkle::JointDesc joint;
      joint.name = JointName(tube, i);
      joint.parent = i == 0 ? 0 : static_cast<int>(joints.size()) - 1;
      joint.rest.translation = i == 0 ? tube.start - joints[0].rest.translation : step;
      joints.push_back(joint);
    }
  }
  return joints;
}

// The bending joints: those with a parent in the same chain. They are straight at rest.
std::vector<std::size_t> BendingJoints(const std::vector<wrinkle::JointDesc>& joints) {
  std::vector<std::size_t> bending;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].parent > 0) bending.push_back(i);
  }
  return bending;
}

// Hinges first, then balls, distributed over the chains.
void AddRig(const std::vector<wrinkle::JointDesc>& joints, int hinges, int balls,
            Character* character) {
  wrinkle::Rig& rig = character->rig;
  rig.name = "thesis body";
  const int drivers = std::min(hinges + balls, kNumBendingJoints);
  const std::vector<std::size_t> bending = BendingJoints(joints);
  for (int i = 0; i < drivers; ++i) {
    const std::size_t index = bending[static_cast<std::size_t>(i * kNumBendingJoints / drivers)];
    const std::string& name = joints[index].name;
    const std::string& parent = joints[static_cast<std::size_t>(joints[index].parent)].name;
    wrinkle::Driver driver;
    driver.name = name;
    wrinkle::Region region;
    region.name = name;
    region.mask.kind = wrinkle::Mask::Kind::kSkinning;
    if (i < hinges) {
      driver.kind = wrinkle::Driver::Kind::kHinge;
      driver.hinge.parent = parent;
      driver.hinge.joint = name;
      region.feeds = {{"folds", {{name, "flexed", 1.0f}}}};
    } else {
      driver.kind = wrinkle::Driver::Kind::kBall;
      driver.ball.parent = parent;
      driver.ball.joint = name;
      region.feeds = {{"folds",
                       {{name, "front", 1.0f},
                        {name, "back", 1.0f},
                        {name, "left", 1.0f},
                        {name, "right", 1.0f}}}};
    }
    rig.drivers.push_back(driver);
    rig.regions.push_back(region);
  }
  if (drivers == 0) return;
  wrinkle::WrinkleMap folds;
  folds.name = "folds";
  folds.normal = "folds.png";
  rig.wrinkle_maps.push_back(folds);
  character->rig_pictures.emplace_back("folds.png", 0);
}

}  // namespace

Character MakeBody(int hinges, int balls) {
  Character character;
  character.name = "body";
  const std::vector<wrinkle::JointDesc> joints = Joints();
  render::test::SetSkeleton(joints, &character);
  Material cloth;
  cloth.name = "cloth";
  cloth.kind = Material::Kind::kCloth;
  cloth.base_colour = {0.35f, 0.38f, 0.45f, 1.0f};
  cloth.normal_texture = 1;
  character.materials.push_back(cloth);
  Mesh mesh;
  mesh.name = "body";
  mesh.material = 0;
  int first_joint = 1;
  for (std::size_t tube = 0; tube < kTubes.size(); ++tube) {
    AddTube(tube, first_joint, &mesh);
    first_joint += kTubes[tube].joints;
  }
  character.meshes.push_back(std::move(mesh));
  character.pictures.push_back(render::test::NormalMapOf("folds.png", 1024, [](float u, float v) {
    return 0.002f * std::cos(kTwoPi * (6.0f * u + 80.0f * v));
  }));
  character.pictures.push_back(render::test::NormalMapOf("weave.png", 1024, [](float u, float v) {
    return 0.0002f * std::cos(kTwoPi * 180.0f * u) * std::cos(kTwoPi * 180.0f * v);
  }));
  AddRig(joints, hinges, balls, &character);
  return character;
}

}  // namespace furrow::bench
