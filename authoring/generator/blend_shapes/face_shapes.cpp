// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/blend_shapes/face_shapes.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include "authoring/generator/head/head_shape.h"
#include "authoring/shapes/morph.h"
#include "base/scalar.h"
#include "character/mesh/weld.h"
#include "rig/shapes/arkit_shapes.h"
#include "wrinkle/skeleton/pose.h"
#include "wrinkle/skeleton/reference_pose.h"

namespace furrow::authoring {
namespace {

using glm::vec3;
using Locals = std::vector<wrinkle::Transform>;

// Smaller changes are rounding errors of the skinning.
constexpr float kLeastMove = 1e-6f;  // metres
constexpr float kLeastTurn = 1e-3f;  // of a unit normal

Status Apply(const character::Character& character, std::string_view name, Locals* locals) {
  const auto& poses = character.rig.reference_poses;
  const auto pose = std::find_if(poses.begin(), poses.end(),
                                 [&](const auto& known) { return known.name == name; });
  if (pose == poses.end()) {
    return {StatusCode::kNotFound, "the rig has no reference pose '" + std::string(name) + "'",
            character.rig.name};
  }
  return wrinkle::ApplyReferencePose(*pose, character.skeleton, *locals);
}

std::vector<glm::mat4> SkinMatrices(const character::Character& character, const Locals& locals) {
  std::vector<glm::mat4> matrices(locals.size());
  // Cannot fail: the sizes are those of the skeleton, and verified rigs have finite poses.
  (void)wrinkle::LocalToModelJob{&character.skeleton, locals, matrices}.Run();
  for (std::size_t j = 0; j < matrices.size(); ++j) {
    matrices[j] = matrices[j] * character.inverse_bind_matrices[j];
  }
  return matrices;
}

// A mesh under a pose of joints, blended linearly as the renderer does.
struct PosedMesh {
  std::vector<vec3> positions;
  std::vector<vec3> tangents;
};

PosedMesh Skin(const character::Mesh& mesh, const std::vector<glm::mat4>& matrices) {
  PosedMesh posed;
  for (const character::Vertex& vertex : mesh.vertices) {
    glm::mat4 sum(0.0f);
    for (int k = 0; k < 4; ++k) sum += vertex.skin_weights[k] * matrices[vertex.joints[k]];
    posed.positions.emplace_back(sum * glm::vec4(vertex.position, 1.0f));
    posed.tangents.push_back(glm::mat3(sum) * vec3(vertex.tangent));
  }
  return posed;
}

// The tongue slides over the lower teeth and lip. Its root stays, its tip moves farthest and down.
vec3 TongueOut(const vec3& place) {
  constexpr float kRootZ = 3.0f, kTipZ = 8.35f;  // head space, centimetres
  const float along = std::clamp((place.z - kRootZ) / (kTipZ - kRootZ), 0.0f, 1.0f);
  const float share = along * along * (3.0f - 2.0f * along);
  const float down = Smoothstep(0.6f, 1.0f, along);
  return vec3(-0.12f * place.x * share, 0.25f * share - 0.9f * down, 3.4f * share) / 100.0f;
}

// The part of a shape that no joint of the face can make.
void Sculpt(std::string_view shape, const character::Mesh& mesh, std::vector<vec3>* positions) {
  if (shape != "tongueOut" || mesh.name != "tongue") return;
  for (std::size_t v = 0; v < positions->size(); ++v) {
    (*positions)[v] += TongueOut(ModelToHead(mesh.vertices[v].position));
  }
}

class TargetMaker {
 public:
  explicit TargetMaker(const character::Mesh& mesh)
      : mesh_(mesh), welded_(character::WeldVertices(mesh)) {}

  // The target that takes the surface from `base` to `posed`.
  character::MorphTarget Make(int shape, const PosedMesh& base, const PosedMesh& posed) const {
    const auto from = SurfaceNormals(base.positions, mesh_.indices, welded_);
    const auto to = SurfaceNormals(posed.positions, mesh_.indices, welded_);
    character::MorphTarget target{.shape = shape, .deltas = {}};
    for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v) {
      const vec3 move = posed.positions[v] - base.positions[v];
      const vec3 turn = to[v] - from[v];
      const bool moves = glm::length(move) >= kLeastMove;
      if (!moves && glm::length(turn) < kLeastTurn) continue;
      const vec3 rest(mesh_.vertices[v].tangent);
      const vec3 normal = glm::normalize(mesh_.vertices[v].normal + turn);
      const vec3 turned = rest + posed.tangents[v] - base.tangents[v];
      const vec3 across = turned - normal * glm::dot(normal, turned);
      const float length = glm::length(across);
      // Where the surface turns its tangent away, the bitangent stays.
      const vec3 aside = glm::normalize(
          glm::cross(glm::cross(mesh_.vertices[v].normal, rest), normal) + 1e-6f * rest);
      target.deltas.push_back({.vertex = v,
                               .position = moves ? move : vec3(0.0f),
                               .normal = turn,
                               .tangent = (length > 0.1f ? across / length : aside) - rest});
    }
    return target;
  }

 private:
  const character::Mesh& mesh_;
  std::vector<std::uint32_t> welded_;
};

struct ShapePose {
  std::string name;
  std::vector<glm::mat4> base;   // skin matrices of the pose that the shape starts from
  std::vector<glm::mat4> posed;  // ... and at which it is 1
};

Result<std::vector<ShapePose>> ShapePoses(const character::Character& character) {
  std::vector<ShapePose> poses;
  for (const std::string_view name : rig::ArkitShapes()) {
    Locals locals(character.skeleton.rest_pose().begin(), character.skeleton.rest_pose().end());
    ShapePose pose{.name = std::string(name), .base = {}, .posed = {}};
    if (pose.name == "mouthClose") FURROW_RETURN_IF_ERROR(Apply(character, "jawOpen", &locals));
    pose.base = SkinMatrices(character, locals);
    FURROW_RETURN_IF_ERROR(Apply(character, name, &locals));
    pose.posed = SkinMatrices(character, locals);
    poses.push_back(std::move(pose));
  }
  return poses;
}

}  // namespace

Status AddFaceShapes(character::Character* character) {
  const auto poses = ShapePoses(*character);
  FURROW_RETURN_IF_ERROR(poses);
  for (character::Mesh& mesh : character->meshes) {
    const TargetMaker maker(mesh);
    for (std::size_t i = 0; i < poses->size(); ++i) {
      const ShapePose& pose = (*poses)[i];
      const PosedMesh base = Skin(mesh, pose.base);
      PosedMesh posed = Skin(mesh, pose.posed);
      Sculpt(pose.name, mesh, &posed.positions);
      auto target = maker.Make(static_cast<int>(i), base, posed);
      if (!target.deltas.empty()) mesh.morph_targets.push_back(std::move(target));
    }
  }
  for (const ShapePose& pose : *poses) character->shapes.push_back(pose.name);
  return {};
}

}  // namespace furrow::authoring
