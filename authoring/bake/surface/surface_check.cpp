// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/surface/surface_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "authoring/bake/surface/bake_surface.h"
#include "authoring/bake/surface/uv_check.h"
#include "base/status.h"

namespace furrow::authoring {
namespace {

std::string MeshName(const character::Character& character, int mesh) {
  return "mesh '" + character.meshes[static_cast<std::size_t>(mesh)].name + "'";
}

std::string Percent(float share) {
  char text[16];
  std::snprintf(text, sizeof(text), "%.1f%%", static_cast<double>(100.0f * share));
  return text;
}

Status Refuse(std::string what, std::string where, std::string todo) {
  return {StatusCode::kInvalidArgument, std::move(what), std::move(where), std::move(todo)};
}

// A texel that two triangles share can hold the folds of one of them only. That is right for
// mirrored halves, whose folds are mirrored too, so an overlap prevents no bake.
void WarnOfOverlap(const character::Character& character, const UvReport& uvs,
                   std::vector<std::string>* warnings) {
  if (!(uvs.overlapping > kTolerableUvOverlap) || !uvs.example) return;
  const UvReport::Overlap& at = *uvs.example;
  char place[64];
  std::snprintf(place, sizeof(place), "%.3f, %.3f", static_cast<double>(at.uv.x),
                static_cast<double>(at.uv.y));
  const bool one = at.meshes[0] == at.meshes[1];
  warnings->push_back(MeshName(character, at.meshes[0]) + ": UVs overlap on " +
                      Percent(uvs.overlapping) + " of the atlas: triangles " +
                      std::to_string(at.triangles[0]) + " and " + std::to_string(at.triangles[1]) +
                      (one ? "" : " of " + MeshName(character, at.meshes[1])) + " share (" + place +
                      "); both show the folds of the half at the larger x");
}

Status CheckSkin(const character::Character& character, int index) {
  const character::Mesh& mesh = character.meshes[static_cast<std::size_t>(index)];
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const float* w = mesh.vertices[v].skin_weights;
    if (std::abs(w[0] + w[1] + w[2] + w[3] - 1.0f) <= 0.01f) continue;
    char sum[32];
    std::snprintf(sum, sizeof(sum), "%g", static_cast<double>(w[0] + w[1] + w[2] + w[3]));
    return Refuse(
        "the skin weights of vertex " + std::to_string(v) + " sum to " + sum + " instead of 1",
        MeshName(character, index), "bind every vertex to a joint");
  }
  return {};
}

// The only joint that moves a mesh, or -1 if there are several.
int OnlyJoint(const character::Mesh& mesh) {
  int joint = -1;
  for (const character::Vertex& vertex : mesh.vertices) {
    for (int i = 0; i < 4; ++i) {
      if (!(vertex.skin_weights[i] > 0.0f)) continue;
      if (joint >= 0 && joint != vertex.joints[i]) return -1;
      joint = vertex.joints[i];
    }
  }
  return joint;
}

void Warn(const character::Character& character, const UvReport& uvs, std::span<const int> meshes,
          const std::string& kind, std::vector<std::string>* warnings) {
  const auto count = [&](int triangles, const std::string& one, const std::string& several) {
    if (triangles == 1) warnings->push_back("1 triangle of the " + kind + " " + one);
    if (triangles < 2) return;
    warnings->push_back(std::to_string(triangles) + " triangles of the " + kind + " " + several);
  };
  count(uvs.degenerate_triangles, "has no area and is skipped", "have no area and are skipped");
  count(uvs.unmapped_triangles, "has no UVs and gets no folds", "have no UVs and get no folds");
  count(uvs.outside_triangles, "has UVs outside [0, 1], which wrap around",
        "have UVs outside [0, 1], which wrap around");
  for (const int mesh : meshes) {
    if (!character.meshes[static_cast<std::size_t>(mesh)].morph_targets.empty()) continue;
    const int joint = OnlyJoint(character.meshes[static_cast<std::size_t>(mesh)]);
    if (joint < 0) continue;
    warnings->push_back(MeshName(character, mesh) + " follows joint '" +
                        character.skeleton.joint_names()[static_cast<std::size_t>(joint)] +
                        "' rigidly, so no pose can fold it");
  }
}

// A kind of surface: the skin or the clothes.
struct Kind {
  std::vector<int> meshes;
  UvReport uvs;
  [[nodiscard]] bool can_fold() const { return !meshes.empty() && !uvs.no_uvs(); }
};

Status WhyNot(const character::Character& character, const Kind& kind, const std::string& map,
              const std::string& name) {
  if (kind.meshes.empty()) {
    return Refuse("wrinkle map '" + map + "' is drawn on " + name + ", but no mesh is " + name,
                  character.name,
                  "name a material '" + name +
                      "', change the map's surface in the rig, or "
                      "exclude the map with --map");
  }
  return Refuse("the " + name + " has no UVs for wrinkle map '" + map + "'",
                MeshName(character, kind.meshes.front()),
                "unwrap it; wrinkle maps use its UV atlas");
}

Status CheckInverseBinds(const character::Character& character) {
  const auto joints = static_cast<std::size_t>(character.skeleton.num_joints());
  if (character.inverse_bind_matrices.size() == joints) return {};
  return Refuse(std::to_string(character.inverse_bind_matrices.size()) +
                    " inverse bind matrices for " + std::to_string(joints) + " joints",
                character.name, "export the skin with the inverse bind matrices of all joints");
}

}  // namespace

Result<BakeableMaps> CheckSurfaces(const character::Character& character,
                                   std::span<const std::string> maps,
                                   std::vector<std::string>* warnings) {
  FURROW_RETURN_IF_ERROR(CheckInverseBinds(character));
  BakeableMaps bakeable;
  Status first(StatusCode::kNotFound, "the rig has no wrinkle map to bake", character.name);
  std::optional<Kind> kinds[2];  // skin, cloth
  for (const wrinkle::WrinkleMap& map : character.rig.wrinkle_maps) {
    const bool named = std::find(maps.begin(), maps.end(), map.name) != maps.end();
    if (!named && !maps.empty()) continue;
    const bool cloth = GoesOnCloth(character, map);
    const std::string name = cloth ? "cloth" : "skin";
    std::optional<Kind>& kind = kinds[cloth ? 1 : 0];
    const bool is_new = !kind.has_value();
    if (is_new) {
      kind = Kind{MeshesOn(character, cloth), {}};
      kind->uvs = CheckUvs(character, kind->meshes);
    }
    if (!kind->can_fold()) {
      const Status why = WhyNot(character, *kind, map.name, name);
      if (named) return why;
      if (bakeable.left_out.empty()) first = why;
      bakeable.left_out.push_back(why.what() + "; the map is left out");
      warnings->push_back(bakeable.left_out.back());
      continue;
    }
    bakeable.names.push_back(map.name);
    if (!is_new) continue;
    for (const int mesh : kind->meshes) {
      FURROW_RETURN_IF_ERROR(CheckSkin(character, mesh));
    }
    WarnOfOverlap(character, kind->uvs, warnings);
    Warn(character, kind->uvs, kind->meshes, name, warnings);
  }
  if (bakeable.names.empty()) return first;
  return bakeable;
}

}  // namespace furrow::authoring
