// SPDX-License-Identifier: Apache-2.0
#include "test_character.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include "character_parts.h"

namespace furrow::render::test {
namespace {

using character::Character;
using character::Material;
using character::Mesh;
using character::Vertex;

constexpr float kTwoPi = glm::two_pi<float>();

int AddPicture(Character* character, character::Picture picture) {
  character->pictures.push_back(std::move(picture));
  return static_cast<int>(character->pictures.size()) - 1;
}

void AddRigPicture(Character* character, character::Picture picture) {
  const std::string name = picture.name;
  character->rig_pictures.emplace_back(name, AddPicture(character, std::move(picture)));
}

wrinkle::Driver BlendShapeDriver(const std::string& name) {
  wrinkle::Driver driver;
  driver.name = name;
  driver.kind = wrinkle::Driver::Kind::kBlendShape;
  driver.blend_shape.blend_shape = name;
  return driver;
}

wrinkle::WrinkleMap MapOf(const std::string& name) {
  wrinkle::WrinkleMap map;
  map.name = name;
  map.normal = name + ".png";
  return map;
}

wrinkle::Region TextureRegion(const std::string& name, int channel) {
  wrinkle::Region region;
  region.name = name;
  region.mask.texture = "masks.png";
  region.mask.channel = channel;
  region.modulation = wrinkle::Modulation::kLinear;
  return region;
}

// A point of the egg; u runs around once from the back, v from the top.
glm::vec3 Egg(float u, float v) {
  const float longitude = kTwoPi * (u - 0.5f);  // 0 at the front, positive to the subject's left
  const float latitude = glm::pi<float>() * v;
  const float radius = 0.085f * std::sin(latitude) * (1.0f - 0.12f * std::cos(latitude) * -1.0f);
  return {radius * std::sin(longitude), 1.6f + 0.12f * std::cos(latitude),
          1.15f * radius * std::cos(longitude)};
}

Vertex EggVertex(float u, float v) {
  Vertex vertex;
  vertex.position = Egg(u, v);
  const float safe_v = std::clamp(v, 0.002f, 0.998f);
  const float e = 1e-3f;
  const glm::vec3 along = glm::normalize(Egg(u + e, safe_v) - Egg(u - e, safe_v));
  const glm::vec3 down = glm::normalize(Egg(u, safe_v + e) - Egg(u, safe_v - e));
  vertex.normal = glm::normalize(glm::cross(down, along));
  vertex.tangent = glm::vec4(along, 1.0f);
  vertex.uv = {u, v};
  // The influence of the brow joint fades in smoothly around a point at the upper front.
  const float distance = glm::length(vertex.position - glm::vec3(0.0f, 1.64f, 0.09f));
  const float brow = std::clamp(1.0f - distance / 0.07f, 0.0f, 1.0f);
  vertex.joints[0] = 1;
  vertex.joints[1] = 2;
  vertex.skin_weights[0] = 1.0f - brow;
  vertex.skin_weights[1] = brow;
  return vertex;
}

Mesh MakeEgg() {
  Mesh mesh;
  mesh.name = "egg";
  mesh.material = 0;
  AddGrid(48, 32, EggVertex, &mesh);
  return mesh;
}

void AddHeadRig(Character* character) {
  wrinkle::Rig& rig = character->rig;
  rig.name = "egg";
  rig.anchor = "head";
  for (const char* name : {"l_stretch", "l_squash", "r_stretch", "r_squash"}) {
    rig.drivers.push_back(BlendShapeDriver(name));
  }
  wrinkle::Driver hinge;
  hinge.name = "brow";
  hinge.kind = wrinkle::Driver::Kind::kHinge;
  hinge.hinge.parent = "head";
  hinge.hinge.joint = "brow";
  rig.drivers.push_back(hinge);
  for (const auto& [name, channel] : {std::pair("left", 0), std::pair("right", 1)}) {
    wrinkle::Region region = TextureRegion(name, channel);
    for (const char* map : {"stretch", "squash"}) {
      region.feeds.push_back({map, {{std::string(1, name[0]) + "_" + map, "value", 1.0f}}});
    }
    rig.regions.push_back(region);
  }
  wrinkle::Region brow;
  brow.name = "brow";
  brow.mask.kind = wrinkle::Mask::Kind::kSkinning;
  brow.modulation = wrinkle::Modulation::kLinear;
  brow.feeds.push_back({"folds", {{"brow", "flexed", 1.0f}}});
  rig.regions.push_back(brow);
  for (const char* map : {"stretch", "squash", "folds"}) rig.wrinkle_maps.push_back(MapOf(map));
}

void AddHeadPictures(Character* character) {
  AddRigPicture(character, MakePicture("masks.png", 64, [](float u, float v) {
                  const float left = std::clamp((u - 0.5f) * 16.0f, 0.0f, 1.0f);
                  const float right = std::clamp((0.5f - u) * 16.0f, 0.0f, 1.0f);
                  const float band = v > 0.25f && v < 0.75f ? 1.0f : 0.0f;
                  return glm::vec4(left * band, right * band, 0.0f, 0.0f);
                }));
  const auto waves = [](float cycles_u, float cycles_v, float height) {
    return
        [=](float u, float v) { return height * std::cos(kTwoPi * (cycles_u * u + cycles_v * v)); };
  };
  AddRigPicture(character, NormalMapOf("stretch.png", 128, waves(16, 0, 0.004f)));
  AddRigPicture(character, NormalMapOf("squash.png", 128, waves(0, 12, 0.006f)));
  AddRigPicture(character, NormalMapOf("folds.png", 128, waves(10, 10, 0.004f)));
}

}  // namespace

character::Picture MakePicture(const std::string& name, int size,
                               const std::function<glm::vec4(float, float)>& function) {
  character::Picture picture{name, size, size, 4, {}, {}};
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const glm::vec4 value = function((x + 0.5f) / size, (y + 0.5f) / size);
      for (int channel = 0; channel < 4; ++channel) {
        const float clamped = std::clamp(value[channel], 0.0f, 1.0f);
        picture.pixels16.push_back(static_cast<std::uint16_t>(clamped * 65535.0f + 0.5f));
      }
    }
  }
  return picture;
}

character::Picture NormalMapOf(const std::string& name, int size,
                               const std::function<float(float, float)>& height) {
  return MakePicture(name, size, [&](float u, float v) {
    const float e = 1e-3f;
    const float du = (height(u + e, v) - height(u - e, v)) / (2.0f * e);
    const float dv = (height(u, v + e) - height(u, v - e)) / (2.0f * e);
    // y points up in the picture, v down.
    const glm::vec3 n = glm::normalize(glm::vec3(-du, dv, 1.0f));
    return glm::vec4(n * 0.5f + 0.5f, 1.0f);
  });
}

Character MakeHead() {
  Character character;
  character.name = "egg";
  SetSkeleton({Joint("root", -1, {0.0f, 1.4f, 0.0f}), Joint("head", 0, {0.0f, 0.2f, 0.0f}),
               Joint("brow", 1, {0.0f, 0.04f, 0.05f})},
              &character);
  Material skin;
  skin.name = "skin";
  skin.kind = Material::Kind::kSkin;
  skin.base_colour = {0.62f, 0.40f, 0.30f, 1.0f};
  character.materials.push_back(skin);
  character.meshes.push_back(MakeEgg());
  AddHeadRig(&character);
  AddHeadPictures(&character);
  return character;
}

Character MakePlane(int map_size, const std::function<float(float, float)>& base,
                    const std::vector<std::function<float(float, float)>>& wrinkles) {
  Character character;
  character.name = "plane";
  const wrinkle::JointDesc root = Joint("root", -1, glm::vec3(0.0f));
  SetSkeleton({root}, &character);
  Mesh mesh;
  mesh.material = 0;
  for (const auto& [x, y] : {std::pair(-1.0f, -1.0f), {1.0f, -1.0f}, {1.0f, 1.0f}, {-1.0f, 1.0f}}) {
    Vertex vertex;
    vertex.position = {x, y, 0.0f};
    vertex.uv = {0.5f + 0.5f * x, 0.5f - 0.5f * y};
    mesh.vertices.push_back(vertex);
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  character.meshes.push_back(mesh);
  Material material;
  material.kind = Material::Kind::kSkin;
  material.normal_texture = AddPicture(&character, NormalMapOf("base", map_size, base));
  character.materials.push_back(material);
  AddRigPicture(&character,
                MakePicture("masks.png", 4, [](float, float) { return glm::vec4(1, 0, 0, 0); }));
  for (std::size_t i = 0; i < wrinkles.size(); ++i) {
    const std::string index = std::to_string(i);
    wrinkle::Region region = TextureRegion("r" + index, 0);
    region.feeds.push_back({"m" + index, {{"r" + index, "value", 1.0f}}});
    character.rig.regions.push_back(region);
    character.rig.drivers.push_back(BlendShapeDriver("r" + index));
    character.rig.wrinkle_maps.push_back(MapOf("m" + index));
    AddRigPicture(&character, NormalMapOf("m" + index + ".png", map_size, wrinkles[i]));
  }
  return character;
}

Character MakeSheet(std::uint32_t columns, std::uint32_t rows,
                    const std::function<void(Vertex*)>& adjust) {
  Character sheet = MakePlane(4, [](float, float) { return 0.0f; }, {});
  Mesh& mesh = sheet.meshes[0];
  mesh.vertices.clear();
  mesh.indices.clear();
  AddGrid(
      columns, rows,
      [&](float u, float v) {
        Vertex vertex;
        vertex.position = {2.0f * u - 1.0f, 1.0f - 2.0f * v, 0.0f};
        vertex.uv = {u, v};
        if (adjust) adjust(&vertex);
        return vertex;
      },
      &mesh);
  return sheet;
}

namespace {

std::vector<std::string> BlendShapesOf(const Character& character) {
  std::vector<std::string> names;
  for (const wrinkle::Driver& driver : character.rig.drivers) {
    if (driver.kind == wrinkle::Driver::Kind::kBlendShape) names.push_back(driver.name);
  }
  return names;
}

}  // namespace

Subject::Subject(const Character& character)
    : binding(Expect(wrinkle::RigBinding::Create(character.rig, character.skeleton,
                                                 BlendShapesOf(character)))),
      blend_shapes(BlendShapesOf(character)),
      model(static_cast<std::size_t>(character.skeleton.num_joints())),
      driver_values(binding.driver_value_names().size()),
      weights(binding.weight_names().size()) {
  pose.SetRest(character.skeleton);
  pose.blend_shapes.assign(blend_shapes.size(), 0.0f);
  Solve();
}

void Subject::Set(const std::string& blend_shape, float value) {
  const auto found = std::find(blend_shapes.begin(), blend_shapes.end(), blend_shape);
  pose.blend_shapes.at(static_cast<std::size_t>(found - blend_shapes.begin())) = value;
}

void Subject::Solve() {
  using wrinkle::JobStatus;
  const wrinkle::LocalToModelJob to_model{&binding.skeleton(), pose.joints, model};
  // The subject owns the binding and outlives the solver.
  wrinkle::SubjectSolver solver(
      std::shared_ptr<const wrinkle::RigBinding>(std::shared_ptr<void>(), &binding), false);
  if (to_model.Run() != JobStatus::kOk || solver.Update(pose, 0.0) != JobStatus::kOk) {
    std::abort();
  }
  std::ranges::copy(solver.driver_values(), driver_values.begin());
  std::ranges::copy(solver.wrinkle_weights(), weights.begin());
}

}  // namespace furrow::render::test
