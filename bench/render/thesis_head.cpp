// SPDX-License-Identifier: Apache-2.0
#include "bench/render/thesis_head.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/unit/render/character_parts.h"
#include "tests/unit/render/test_character.h"

namespace furrow::bench {
namespace {

using character::Character;
using character::Material;
using character::Mesh;
using character::Vertex;

constexpr int kRegions = 8;
constexpr int kMapSize = 512;
constexpr std::uint32_t kColumns = 44;
constexpr std::uint32_t kRows = 35;
static_assert(kColumns * kRows * 2 == kHeadTriangles);
constexpr glm::vec3 kRadii{0.085f, 0.12f, 0.098f};
constexpr float kTwoPi = glm::two_pi<float>();

// (u, v) of the centre of each region on the face. u = 0.5 is the front of the head.
glm::vec2 RegionCentre(int region) {
  const float side = region % 2 == 0 ? 0.06f : -0.06f;
  return {0.5f + side, 0.3f + 0.13f * static_cast<float>(region / 2)};
}

glm::vec3 OnHead(float u, float v) {
  const float longitude = kTwoPi * (u - 0.5f);
  const float polar = glm::pi<float>() * v;
  return kRadii * glm::vec3(std::sin(polar) * std::sin(longitude), std::cos(polar),
                            std::sin(polar) * std::cos(longitude));
}

// 1 at the centre of a region, 0 at a distance of a tenth of the map.
float RegionMask(int region, float u, float v) {
  const float distance = glm::length(glm::vec2(u, v) - RegionCentre(region)) / 0.1f;
  return std::clamp(1.0f - distance * distance, 0.0f, 1.0f);
}

Vertex HeadVertex(float u, float v) {
  Vertex vertex;
  const glm::vec3 point = OnHead(u, v);
  vertex.position = point;
  vertex.normal = glm::normalize(point / (kRadii * kRadii));
  const float longitude = kTwoPi * (u - 0.5f);
  vertex.tangent = {std::cos(longitude), 0.0f, -std::sin(longitude), 1.0f};
  vertex.uv = {u, v};
  // The head joint and the two strongest regions at this vertex.
  float strongest[2] = {0.0f, 0.0f};
  for (int region = 0; region < kRegions; ++region) {
    const float mask = RegionMask(region, u, v);
    const int slot = strongest[0] <= strongest[1] ? 0 : 1;
    if (mask > strongest[slot]) {
      strongest[slot] = mask;
      vertex.joints[1 + slot] = static_cast<std::uint16_t>(1 + region);
    }
  }
  const float sum = 1.0f + strongest[0] + strongest[1];
  vertex.skin_weights[0] = 1.0f / sum;
  vertex.skin_weights[1] = strongest[0] / sum;
  vertex.skin_weights[2] = strongest[1] / sum;
  return vertex;
}

struct Grid {
  int columns = 1;
  int rows = 1;
};

// The number of columns that fits a 16:10 picture.
Grid GridOf(int heads) {
  const int columns =
      std::max(1, static_cast<int>(std::lround(std::sqrt(heads * 1.6 * 1.2 / 0.9))));
  return {std::min(columns, heads), (heads + columns - 1) / columns};
}

constexpr float kPitchX = 0.20f;
constexpr float kPitchY = 0.26f;

std::string Side(int region) { return "region" + std::to_string(region); }

void AddRig(Character* character) {
  wrinkle::Rig& rig = character->rig;
  rig.name = "thesis head";
  rig.anchor = "head";
  for (const char* map : {"stretch", "squash"}) {
    const float sign = map == std::string("stretch") ? 1.0f : -1.0f;
    wrinkle::ReferencePose pose;
    pose.name = map;
    for (int region = 0; region < kRegions; ++region) {
      wrinkle::JointDelta delta;
      delta.joint = Side(region);
      delta.translation = {0.0f, sign * 0.01f, 0.0f};
      pose.joints.push_back(delta);
    }
    rig.reference_poses.push_back(pose);
    wrinkle::WrinkleMap wrinkle_map;
    wrinkle_map.name = map;
    wrinkle_map.normal = std::string(map) + ".png";
    wrinkle_map.height = std::string(map) + "_height.png";
    wrinkle_map.height_mm = map == std::string("stretch") ? 1.2f : 1.8f;
    rig.wrinkle_maps.push_back(wrinkle_map);
  }
  for (int index = 0; index < kRegions; ++index) {
    wrinkle::Driver driver;
    driver.name = Side(index);
    driver.pose.points.push_back({Side(index), wrinkle::ControlPoint::Kind::kOrigin, {}, 0.0f});
    driver.pose.values = {{"stretch", "stretch"}, {"squash", "squash"}};
    rig.drivers.push_back(driver);
    wrinkle::Region region;
    region.name = Side(index);
    region.mask.texture = index < 4 ? "masks0.png" : "masks1.png";
    region.mask.channel = index % 4;
    region.feeds = {{"stretch", {{Side(index), "stretch", 1.0f}}},
                    {"squash", {{Side(index), "squash", 1.0f}}}};
    rig.regions.push_back(region);
  }
}

int AddPicture(character::Picture picture, Character* character) {
  character->pictures.push_back(std::move(picture));
  return static_cast<int>(character->pictures.size()) - 1;
}

void AddPictures(Character* character) {
  using render::test::MakePicture;
  using render::test::NormalMapOf;
  const auto add_for_rig = [&](character::Picture picture) {
    const std::string name = picture.name;
    character->rig_pictures.emplace_back(name, AddPicture(std::move(picture), character));
  };
  for (int layer = 0; layer < 2; ++layer) {
    add_for_rig(MakePicture("masks" + std::to_string(layer) + ".png", 128, [&](float u, float v) {
      glm::vec4 masks;
      for (int channel = 0; channel < 4; ++channel) {
        masks[channel] = RegionMask(4 * layer + channel, u, v);
      }
      return masks;
    }));
  }
  const auto waves = [](float u_cycles, float v_cycles, float height) {
    return
        [=](float u, float v) { return height * std::cos(kTwoPi * (u_cycles * u + v_cycles * v)); };
  };
  // The same waves in millimetres. The circumference of the head is about 0.6 m.
  const auto heights = [&](const char* name, float u_cycles, float v_cycles, float height) {
    return MakePicture(name, kMapSize, [=](float u, float v) {
      return glm::vec4(0.5f + 0.5f * waves(u_cycles, v_cycles, height)(u, v) / height);
    });
  };
  add_for_rig(heights("stretch_height.png", 40, 4, 0.002f));
  add_for_rig(heights("squash_height.png", 3, 36, 0.003f));
  add_for_rig(NormalMapOf("stretch.png", kMapSize, waves(40, 4, 0.002f)));
  add_for_rig(NormalMapOf("squash.png", kMapSize, waves(3, 36, 0.003f)));
  Material& skin = character->materials.front();
  skin.normal_texture =
      AddPicture(NormalMapOf("pores", kMapSize, waves(90, 110, 0.0004f)), character);
  skin.base_colour_texture = AddPicture(
      MakePicture("colour", kMapSize,
                  [](float u, float v) {
                    const float mottle = 0.03f * std::sin(40.0f * u) * std::sin(33.0f * v);
                    return glm::vec4(0.80f + mottle, 0.65f + mottle, 0.57f + mottle, 1.0f);
                  }),
      character);
}

}  // namespace

Extent HeadsExtent(int heads) {
  const Grid grid = GridOf(heads);
  return {0.5f * kPitchX * static_cast<float>(grid.columns),
          0.5f * kPitchY * static_cast<float>(grid.rows)};
}

std::vector<glm::mat4> HeadPlacements(int heads) {
  const Grid grid = GridOf(heads);
  std::vector<glm::mat4> placements;
  for (int i = 0; i < heads; ++i) {
    const float x =
        static_cast<float>(i % grid.columns) - 0.5f * static_cast<float>(grid.columns - 1);
    const float y = static_cast<float>(i / grid.columns) - 0.5f * static_cast<float>(grid.rows - 1);
    placements.push_back(
        glm::translate(glm::mat4(1.0f), glm::vec3(kPitchX * x, -kPitchY * y, 0.0f)));
  }
  return placements;
}

Character MakeHead() {
  Character character;
  character.name = "head";
  std::vector<wrinkle::JointDesc> joints(1);
  joints[0].name = "head";
  for (int region = 0; region < kRegions; ++region) {
    wrinkle::JointDesc joint;
    joint.name = Side(region);
    joint.parent = 0;
    const glm::vec2 centre = RegionCentre(region);
    joint.rest.translation = OnHead(centre.x, centre.y);
    joints.push_back(joint);
  }
  render::test::SetSkeleton(joints, &character);
  Material skin;
  skin.name = "skin";
  skin.kind = Material::Kind::kSkin;
  character.materials.push_back(skin);
  Mesh mesh;
  mesh.name = "head";
  mesh.material = 0;
  render::test::AddGrid(kColumns, kRows, HeadVertex, &mesh);
  character.meshes.push_back(std::move(mesh));
  AddRig(&character);
  AddPictures(&character);
  return character;
}

}  // namespace furrow::bench
