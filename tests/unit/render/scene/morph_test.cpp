// SPDX-License-Identifier: Apache-2.0
// Faces moved by morph targets, compared with faces whose vertices or joints were moved instead.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "render/renderer.h"
#include "tests/unit/render/character_parts.h"
#include "tests/unit/render/picture_difference.h"
#include "tests/unit/render/reference/scenes.h"
#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

using character::Character;
using character::MorphTarget;
using character::Vertex;

constexpr int kMorphSize = 160;
constexpr glm::vec3 kAside(0.03f, 0.0f, 0.0f);
enum MorphShape { kShift, kBulge, kTilt, kFarAway };

// A target that gives each vertex its delta of a function; unmoved vertices are left out.
MorphTarget TargetOf(const character::Mesh& mesh, int shape,
                     const std::function<character::MorphDelta(const Vertex&)>& delta_of) {
  MorphTarget target{.shape = shape, .deltas = {}};
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
    character::MorphDelta delta = delta_of(mesh.vertices[i]);
    delta.vertex = i;
    if (delta.position == glm::vec3(0.0f) && delta.normal == glm::vec3(0.0f)) continue;
    target.deltas.push_back(delta);
  }
  return target;
}

// The tests' egg with four shapes: the whole face aside, a bulge of the left side, turned normals
// of the lower half, and the whole face 1 m aside.
Character MorphedHead() {
  Character head = test::MakeHead();
  head.shapes = {"shift", "bulge", "tilt", "farAway"};
  character::Mesh& mesh = head.meshes[0];
  mesh.morph_targets = {
      TargetOf(mesh, kShift,
               [](const Vertex&) {
                 return character::MorphDelta{0, kAside};
               }),
      TargetOf(mesh, kBulge,
               [](const Vertex& vertex) {
                 const float side = std::max(0.0f, vertex.position.x - 0.01f);
                 const float wave = std::sin(90.0f * vertex.position.y);
                 return character::MorphDelta{0,
                                              (0.25f + 0.1f * wave) * side * vertex.normal,
                                              {0.0f, 4.0f * side, 0.0f},
                                              {0.0f, 0.0f, 2.0f * side}};
               }),
      TargetOf(mesh, kTilt,
               [](const Vertex& vertex) {
                 const float low = std::max(0.0f, 1.58f - vertex.position.y);
                 return character::MorphDelta{0, glm::vec3(0.0f), {0.0f, -20.0f * low, 0.0f}};
               }),
      TargetOf(mesh, kFarAway, [](const Vertex&) {
        return character::MorphDelta{0, {1.0f, 0.0f, 0.0f}};
      })};
  return head;
}

// The same character without shapes, its vertices moved here.
Character Baked(Character character, const std::vector<float>& shapes) {
  for (character::Mesh& mesh : character.meshes) {
    const std::vector<Vertex> rest = mesh.vertices;
    std::vector<glm::vec3> tangents;
    for (const Vertex& vertex : rest) tangents.emplace_back(vertex.tangent);
    for (const MorphTarget& target : mesh.morph_targets) {
      const float weight = shapes[static_cast<std::size_t>(target.shape)];
      for (const character::MorphDelta& delta : target.deltas) {
        mesh.vertices[delta.vertex].position += weight * delta.position;
        mesh.vertices[delta.vertex].normal += weight * delta.normal;
        tangents[delta.vertex] += weight * delta.tangent;
      }
    }
    for (std::size_t i = 0; i < rest.size(); ++i) {
      mesh.vertices[i].normal = glm::normalize(mesh.vertices[i].normal);
      mesh.vertices[i].tangent = glm::vec4(glm::normalize(tangents[i]), rest[i].tangent.w);
    }
    mesh.morph_targets.clear();
  }
  character.shapes.clear();
  return character;
}

// A renderer with one subject of the character.
struct Drawn {
  explicit Drawn(Character made)
      : character(std::move(made)),
        renderer(test::Expect(Renderer::Create(character))),
        subject(character) {
    request.model = subject.model;
    request.binding = &subject.binding;
    request.wrinkle_weights = subject.weights;
    request.filtered_values = subject.driver_values;
    request.camera.position = {0.1f, 1.65f, 0.8f};
    request.camera.target = {0.0f, 1.6f, 0.0f};
    request.width = request.height = kMorphSize;
    request.settings.anti_aliasing.samples = 1;
  }
  Image Draw(const std::vector<float>& shapes = {}) {
    request.shapes = shapes;
    return test::Expect(renderer->Render(request));
  }

  Character character;
  std::unique_ptr<Renderer> renderer;
  test::Subject subject;
  FrameRequest request;
};

struct Look {
  const char* name;
  std::function<void(Settings*)> set;
};

const Look kLooks[] = {
    {"plain", [](Settings*) {}},
    {"skin with shadows", [](Settings* s) { s->shading = Shading::kSkin; }},
    {"normals", [](Settings* s) { s->view = View::kNormal; }},
    {"wireframe", [](Settings* s) { s->view = View::kWireframe; }},
};

TEST(Morph, WithoutWeightsPicturesAreBitIdenticalToThoseWithoutShapes) {
  Drawn with(MorphedHead());
  Drawn without(test::MakeHead());
  for (const Look& look : kLooks) {
    look.set(&with.request.settings);
    look.set(&without.request.settings);
    const Image want = without.Draw();
    EXPECT_EQ(with.Draw().rgb, want.rgb) << look.name;
    EXPECT_EQ(with.Draw({0.0f, 0.0f, 0.0f, 0.0f}).rgb, want.rgb) << look.name;
    EXPECT_EQ(with.Draw({5e-5f, -5e-5f, 0.0f, 0.0f}).rgb, want.rgb) << look.name;
    EXPECT_NE(with.Draw({0.0f, 1.0f, 0.0f, 0.0f}).rgb, want.rgb) << look.name;
    EXPECT_EQ(with.Draw().rgb, want.rgb) << look.name << ", after a morphed frame";
  }
}

TEST(Morph, PicturesAreThoseOfMovedVertices) {
  const std::vector<float> shapes = {-0.4f, 0.8f, 0.6f, 0.0f};
  Drawn morphed(MorphedHead());
  Drawn baked(Baked(MorphedHead(), shapes));
  for (const Look& look : kLooks) {
    look.set(&morphed.request.settings);
    look.set(&baked.request.settings);
    const Image image = morphed.Draw(shapes);
    EXPECT_LE(test::NumDifferent(image, baked.Draw(), 3), 6) << look.name;
    EXPECT_GT(test::NumDifferent(image, morphed.Draw(), 3), 500) << look.name;
  }
}

// The lower half's normals point down: the lamps above light it less, and nothing moves.
TEST(Morph, NormalsTurnTheShading) {
  Drawn head(MorphedHead());
  const Image still = head.Draw();
  const Image tilted = head.Draw({0.0f, 0.0f, 1.0f, 0.0f});
  int darker = 0;
  int brighter = 0;
  for (std::size_t i = 0; i < still.rgb.size(); i += 3) {
    darker += tilted.rgb[i] + 8 < still.rgb[i] ? 1 : 0;
    brighter += tilted.rgb[i] > still.rgb[i] + 8 ? 1 : 0;
  }
  EXPECT_GT(darker, 300);
  EXPECT_LT(brighter, darker / 4);
}

// Two faces in one frame, one moved by a shape and one by its root joint, cast shadows on each
// other.
TEST(Morph, SubjectsOfOneFrameHaveTheirOwnWeights) {
  Drawn head(MorphedHead());
  head.request.settings.shading = Shading::kSkin;
  head.request.camera.position = {0.0f, 1.6f, 1.4f};
  const auto pair = [&](float left, float right, bool by_shapes) {
    std::vector<test::Subject> people;
    std::vector<std::vector<float>> shapes;
    for (const float weight : {left, right}) {
      people.emplace_back(head.character);
      shapes.push_back({by_shapes ? weight : 0.0f, 0.0f, 0.0f, 0.0f});
      if (!by_shapes) people.back().pose.joints[0].translation += weight * kAside;
      people.back().Solve();
    }
    std::vector<PosedSubject> drawn;
    for (std::size_t i = 0; i < people.size(); ++i) {
      const glm::vec3 place(i == 0 ? -0.14f : 0.14f, 0.0f, i == 0 ? 0.1f : 0.0f);
      drawn.push_back({people[i].model, shapes[i], &people[i].binding, people[i].weights,
                       people[i].driver_values, glm::translate(glm::mat4(1.0f), place)});
    }
    static_cast<PosedSubject&>(head.request) = drawn[0];
    head.request.others = std::span(drawn).subspan(1);
    return test::Expect(head.renderer->Render(head.request));
  };
  const Image image = pair(-1.0f, 1.5f, true);
  EXPECT_LE(test::NumDifferent(image, pair(-1.0f, 1.5f, false), 3), 6);
  EXPECT_GT(test::NumDifferent(image, pair(1.5f, -1.0f, true), 3), 500);
  EXPECT_GT(test::NumDifferent(image, pair(-1.0f, 0.0f, true), 3), 200);
}

// A sphere over a plane: its shadow moves with it although no joint does, and moves back.
TEST(Morph, ShadowsMove) {
  const test::SphereOnPlane scene{{0.0, 0.08, 0.0}, 0.06};
  Character character = test::MakeSphereOnPlane(scene, 0.6f);
  character.shapes = {"shift"};
  character::Mesh* sphere = nullptr;
  for (character::Mesh& mesh : character.meshes) {
    if (sphere == nullptr || mesh.vertices.size() > sphere->vertices.size()) sphere = &mesh;
  }
  sphere->morph_targets = {TargetOf(*sphere, 0, [](const Vertex&) {
    return character::MorphDelta{0, {0.1f, 0.0f, 0.0f}};
  })};
  Camera camera;
  camera.position = {0.0f, 0.35f, 0.60f};
  camera.target = {0.0f, 0.05f, 0.0f};
  const auto draw = [&](const Character& drawn, const std::vector<std::vector<float>>& frames) {
    FrameRequest request = test::SceneRequest(drawn, camera, kMorphSize, kMorphSize);
    request.settings.shading = Shading::kSkin;
    request.settings.view = View::kShadow;
    const auto renderer = test::Expect(Renderer::Create(drawn));
    Image image;
    for (const std::vector<float>& shapes : frames) {
      request.shapes = shapes;
      image = test::Expect(renderer->Render(request));
    }
    return image;
  };
  const Image still = draw(character, {{}});
  const Image moved = draw(character, {{}, {1.0f}});
  EXPECT_GT(test::NumDifferent(moved, still, 20), 200);
  EXPECT_LE(test::NumDifferent(moved, draw(Baked(character, {1.0f}), {{}}), 3), 6);
  EXPECT_EQ(draw(character, {{}, {1.0f}, {}}).rgb, still.rgb);
}

TEST(Morph, DisplacedSurfacesMove) {
  const std::vector<float> shapes = {-0.4f, 0.8f, 0.0f, 0.0f};
  const auto with_heights = [](Character character) {
    constexpr int kTexels = 64;
    character::Picture picture{"heights", kTexels, kTexels, 1, {}, {}};
    for (int i = 0; i < kTexels * kTexels; ++i) {
      picture.pixels_float.push_back(3.0f * std::sin(0.4f * static_cast<float>(i % kTexels)));
    }
    character.rig_pictures.emplace_back("heights", static_cast<int>(character.pictures.size()));
    character.pictures.push_back(picture);
    for (wrinkle::WrinkleMap& map : character.rig.wrinkle_maps) map.height = "heights";
    return character;
  };
  Drawn morphed(with_heights(MorphedHead()));
  Drawn baked(with_heights(Baked(MorphedHead(), shapes)));
  for (Drawn* drawn : {&morphed, &baked}) {
    drawn->request.settings.shading = Shading::kSkin;
    drawn->request.settings.displacement = {.enabled = true, .edge_pixels = 2.0f, .max_level = 16};
    drawn->subject.Set("l_stretch", 1.0f);
    drawn->subject.Solve();
  }
  const Image image = morphed.Draw(shapes);
  EXPECT_LE(test::NumDifferent(image, baked.Draw(), 6), 60);
  EXPECT_GT(test::NumDifferent(image, morphed.Draw(), 6), 1000);
  morphed.request.settings.displacement.enabled = false;
  EXPECT_GT(test::NumDifferent(image, morphed.Draw(shapes), 6), 100);
}

// The bounds follow the shapes: the face is far outside the picture until its shape moves it in.
TEST(Morph, ADistantFaceMovesIntoThePicture) {
  Drawn head(MorphedHead());
  for (const Shading shading : {Shading::kDiffuse, Shading::kSkin}) {
    head.request.settings.shading = shading;
    head.request.placement = glm::mat4(1.0f);
    const Image here = head.Draw();
    head.request.placement = glm::translate(glm::mat4(1.0f), glm::vec3(-1.0f, 0.0f, 0.0f));
    EXPECT_GT(test::NumDifferent(head.Draw(), here, 3), 1000);
    EXPECT_LE(test::NumDifferent(head.Draw({0.0f, 0.0f, 0.0f, 1.0f}), here, 3), 6);
  }
}

// More faces than one buffer of sums holds.
TEST(Morph, CrowdsAreMorphedInParts) {
  Drawn head(MorphedHead());
  constexpr std::size_t kPeople = 160;
  std::vector<std::vector<float>> shapes;
  std::vector<PosedSubject> drawn;
  for (std::size_t i = 0; i < kPeople; ++i) {
    shapes.push_back({0.01f * static_cast<float>(i), 0.0f, 0.0f, 0.0f});
  }
  const auto draw = [&](bool by_shapes) {
    drawn.clear();
    for (std::size_t i = 0; i < kPeople; ++i) {
      const glm::vec3 spot(0.25f * static_cast<float>(i % 16) - 1.9f,
                           0.3f * static_cast<float>(i / 16) - 1.4f, 0.0f);
      PosedSubject subject = head.request;
      subject.shapes = by_shapes ? std::span<const float>(shapes[i]) : std::span<const float>();
      const glm::vec3 moved = by_shapes ? spot : spot + shapes[i][0] * kAside;
      subject.placement = glm::translate(glm::mat4(1.0f), moved);
      drawn.push_back(subject);
    }
    FrameRequest request = head.request;
    static_cast<PosedSubject&>(request) = drawn[0];
    request.others = std::span(drawn).subspan(1);
    request.camera.position = {0.0f, 1.6f, 6.0f};
    request.width = request.height = 400;
    request.settings.detail.error_pixels = 0.0f;
    return test::Expect(head.renderer->Render(request));
  };
  EXPECT_LE(test::NumDifferent(draw(true), draw(false), 3), 60);
}

// A plane of 2 m, flat at rest, with a shape that raises a bump in its middle.
Character BumpedPlane() {
  Character plane = test::MakeSheet(40, 40);
  character::Mesh& mesh = plane.meshes[0];
  plane.shapes = {"bump"};
  mesh.morph_targets = {TargetOf(mesh, 0, [](const Vertex& vertex) {
    const float near = std::max(0.0f, 1.0f - glm::dot(vertex.position, vertex.position) / 0.09f);
    return character::MorphDelta{
        0, {0.0f, 0.0f, 0.3f * near * near}, 3.0f * near * vertex.position};
  })};
  return plane;
}

// Distant faces are drawn with fewer triangles. They still move by their shapes, without holes.
TEST(Morph, SimplifiedFacesMoveAsWholeOnesDo) {
  Drawn plane(BumpedPlane());
  const auto draw = [&](float bump, float error_pixels) {
    const std::vector<float> shapes = {bump};
    std::vector<PosedSubject> crowd;
    for (const float x : {-1.2f, 1.2f}) {
      PosedSubject subject = plane.request;
      subject.shapes = shapes;
      subject.placement = glm::rotate(glm::translate(glm::mat4(1.0f), {x, 0.0f, 0.0f}), 1.2f,
                                      glm::vec3(0.0f, 1.0f, 0.0f));
      crowd.push_back(subject);
    }
    FrameRequest request = plane.request;
    static_cast<PosedSubject&>(request) = crowd[0];
    request.others = std::span(crowd).subspan(1);
    request.camera.position = {0.0f, 0.0f, 6.0f};
    request.camera.target = {0.0f, 0.0f, 0.0f};
    request.width = request.height = 200;
    request.settings.lights.turn_degrees = 40.0f;  // the key grazes the planes and shows the bump
    request.settings.detail.error_pixels = error_pixels;
    return test::Expect(plane.renderer->Render(request));
  };
  const Image whole = draw(1.0f, 0.0f);
  const Image simple = draw(1.0f, 0.5f);
  EXPECT_GT(test::NumDifferent(whole, draw(0.0f, 0.0f), 24), 400) << "the bump shows";
  EXPECT_GT(test::NumDifferent(whole, simple, 0), 0) << "a simplified level is drawn";
  EXPECT_LT(test::NumDifferent(whole, simple, 24), 80);
}

TEST(Morph, TargetsOutOfRangeAreRejected) {
  Character head = MorphedHead();
  head.meshes[0].morph_targets[1].deltas.back().vertex =
      static_cast<std::uint32_t>(head.meshes[0].vertices.size());
  EXPECT_EQ(Renderer::Create(head).status().code(), StatusCode::kInvalidArgument);
  head = MorphedHead();
  head.meshes[0].morph_targets[1].shape = 4;
  EXPECT_EQ(Renderer::Create(head).status().code(), StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace furrow::render
