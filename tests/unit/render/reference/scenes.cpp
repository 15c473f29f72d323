// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/render/reference/scenes.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include "tests/unit/render/character_parts.h"

namespace furrow::render::test {
namespace {

using character::Character;
using character::Material;
using character::Mesh;
using character::Vertex;

constexpr float kCardFovDegrees = 8.0f;  // nearly parallel rays: N.V is within 0.3% of 1

Character OneJoint(const std::string& name) {
  Character character;
  character.name = name;
  wrinkle::JointDesc root;
  root.name = "root";
  SetSkeleton({root}, &character);
  return character;
}

int AddMaterial(Character* character, Material::Kind kind, float albedo) {
  Material material;
  material.name = "material" + std::to_string(character->materials.size());
  material.kind = kind;
  material.base_colour = glm::vec4(glm::vec3(albedo), 1.0f);
  character->materials.push_back(material);
  return static_cast<int>(character->materials.size()) - 1;
}

// A quad spanned by `corner`, `across` and `up`, facing across x up.
Mesh Quad(int material, const glm::vec3& corner, const glm::vec3& across, const glm::vec3& up) {
  Mesh mesh;
  mesh.name = "quad" + std::to_string(material);
  mesh.material = material;
  for (const auto& [u, v] : {std::pair(0.0f, 0.0f), {1.0f, 0.0f}, {1.0f, 1.0f}, {0.0f, 1.0f}}) {
    Vertex vertex;
    vertex.position = corner + u * across + v * up;
    vertex.normal = glm::normalize(glm::cross(across, up));
    vertex.tangent = glm::vec4(glm::normalize(across), 1.0f);
    vertex.uv = {u, 1.0f - v};
    mesh.vertices.push_back(vertex);
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

Mesh Ball(int material, const glm::vec3& centre, float radius) {
  Mesh mesh;
  mesh.name = "ball";
  mesh.material = material;
  const auto vertex_at = [&](float u, float v) {
    const float longitude = glm::two_pi<float>() * u;
    const float polar = glm::pi<float>() * v;
    Vertex vertex;
    vertex.normal = {std::sin(polar) * std::sin(longitude), std::cos(polar),
                     std::sin(polar) * std::cos(longitude)};
    vertex.position = centre + radius * vertex.normal;
    vertex.tangent = {std::cos(longitude), 0.0f, -std::sin(longitude), 1.0f};
    vertex.uv = {u, v};
    return vertex;
  };
  AddGrid(192, 96, vertex_at, &mesh);
  return mesh;
}

}  // namespace

Character MakeCard(float width, float height, const CardHalf& left, const CardHalf& right) {
  Character card = OneJoint("card");
  const glm::vec3 across(0.5f * width, 0.0f, 0.0f);
  const glm::vec3 up(0.0f, height, 0.0f);
  const glm::vec3 corner = -across - 0.5f * up;
  card.meshes.push_back(Quad(AddMaterial(&card, left.kind, left.albedo), corner, across, up));
  card.meshes.push_back(
      Quad(AddMaterial(&card, right.kind, right.albedo), corner + across, across, up));
  return card;
}

Character MakeSphereOnPlane(const SphereOnPlane& scene, float plane_size) {
  Character character = OneJoint("sphere on plane");
  const glm::vec3 across(plane_size, 0.0f, 0.0f);
  const glm::vec3 back(0.0f, 0.0f, -plane_size);
  const int plane = AddMaterial(&character, Material::Kind::kSkin, 1.0f);
  character.meshes.push_back(Quad(plane, -0.5f * (across + back), across, back));
  const int ball = AddMaterial(&character, Material::Kind::kSkin, 1.0f);
  character.meshes.push_back(Ball(ball, glm::vec3(scene.centre), static_cast<float>(scene.radius)));
  return character;
}

Camera CardCamera(float mm_per_pixel, int height) {
  const float half_height = 0.5f * mm_per_pixel * 1e-3f * static_cast<float>(height);
  Camera camera;
  camera.fov_y_degrees = kCardFovDegrees;
  camera.target = glm::vec3(0.0f);
  camera.position = {0.0f, 0.0f, half_height / std::tan(glm::radians(0.5f * kCardFovDegrees))};
  return camera;
}

Camera SphereCamera(const glm::vec3& position) {
  Camera camera;
  camera.position = position;
  camera.target = {0.0f, 0.05f, 0.0f};
  camera.fov_y_degrees = 30.0f;
  return camera;
}

Ray PixelRay(const Camera& camera, int x, int y, int width, int height) {
  const glm::dvec3 origin(camera.position);
  const glm::dvec3 forward = glm::normalize(glm::dvec3(camera.target) - origin);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0)));
  const glm::dvec3 up = glm::cross(right, forward);
  const double slope = std::tan(glm::radians(0.5 * static_cast<double>(camera.fov_y_degrees)));
  const double across = slope * (2.0 * (x + 0.5) - width) / height;
  const double upwards = slope * (2.0 * (y + 0.5) - height) / height;
  return {origin, glm::normalize(forward + across * right + upwards * up)};
}

std::optional<Hit> FirstHit(const SphereOnPlane& scene, double plane_size, const Ray& ray) {
  const double distance = RayDistance(scene, ray.origin, ray.direction);
  if (!std::isfinite(distance)) return {};
  const glm::dvec3 point = ray.origin + distance * ray.direction;
  const glm::dvec3 outwards = point - scene.centre;
  if (glm::length(outwards) < 1.0001 * scene.radius)
    return Hit{point, glm::normalize(outwards), true};
  if (std::max(std::abs(point.x), std::abs(point.z)) > 0.5 * plane_size) return {};
  return Hit{point, glm::dvec3(0, 1, 0), false};
}

FrameRequest SceneRequest(const Character& character, const Camera& camera, int width, int height) {
  FrameRequest request;
  request.model = character.skeleton.rest_model();
  request.camera = camera;
  request.width = width;
  request.height = height;
  request.settings.shading = Shading::kSkin;
  request.settings.anti_aliasing.samples = 1;
  return request;
}

}  // namespace furrow::render::test
