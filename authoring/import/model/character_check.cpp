// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/character_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <utility>

#include <glm/geometric.hpp>

#include "authoring/bake/bake_poses.h"
#include "authoring/bake/surface/bake_surface.h"
#include "authoring/bake/surface/surface_check.h"
#include "authoring/bake/surface/uv_check.h"
#include "authoring/import/model/face_frame.h"
#include "authoring/shapes/arkit_face.h"
#include "base/joined.h"
#include "character/package/rig_report.h"
#include "character/source_notes.h"
#include "wrinkle/rig/rig_blend_shapes.h"

namespace furrow::authoring {
namespace {

using wrinkle::JointRole;
using wrinkle::kNoJoint;

std::string Count(std::size_t n, const char* one, const char* many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

std::string Number(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", static_cast<double>(value));
  return text;
}

const char* NameOf(ModelKind kind) {
  switch (kind) {
    case ModelKind::kBody: return "the body";
    case ModelKind::kHead: return "the head";
    default: return "the model";
  }
}

glm::vec3 DeltaOf(const character::MorphTarget& target, std::uint32_t vertex) {
  const auto found = std::lower_bound(
      target.deltas.begin(), target.deltas.end(), vertex,
      [](const character::MorphDelta& delta, std::uint32_t v) { return delta.vertex < v; });
  const bool moved = found != target.deltas.end() && found->vertex == vertex;
  return moved ? found->position : glm::vec3(0.0f);
}

// True if a morph target moves the corners of a triangle apart: closed lips and lids may be flat at
// rest.
bool OpensWithAShape(const character::Mesh& mesh, std::size_t triangle) {
  return std::any_of(mesh.morph_targets.begin(), mesh.morph_targets.end(),
                     [&](const character::MorphTarget& target) {
                       const glm::vec3 first = DeltaOf(target, mesh.indices[triangle]);
                       return first != DeltaOf(target, mesh.indices[triangle + 1]) ||
                              first != DeltaOf(target, mesh.indices[triangle + 2]);
                     });
}

// Relative to the longest edge, so that the test does not depend on the file's unit. True for NaN.
bool IsDegenerate(const character::Mesh& mesh, std::size_t triangle) {
  const glm::vec3& a = mesh.vertices[mesh.indices[triangle]].position;
  const glm::vec3& b = mesh.vertices[mesh.indices[triangle + 1]].position;
  const glm::vec3& c = mesh.vertices[mesh.indices[triangle + 2]].position;
  const float longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
  const bool flat = !(glm::length(glm::cross(b - a, c - a)) > 1e-6f * longest * longest);
  return flat && !OpensWithAShape(mesh, triangle);
}

// Collects findings in one pass over the character. Checks are independent, so one report shows all
// faults of a file.
class Checker {
 public:
  Checker(const character::Character& character, const character::SourceNotes& notes,
          const rig::ShapeMatcher& shapes, bool rig_given)
      : character_(character),
        notes_(notes),
        face_(character, shapes),
        has_shape_face_(HasShapeFace(face_)),
        rig_given_(rig_given) {}

  CharacterReport Run(const rig::SkeletonMaps& maps) {
    report_.name = character_.name;
    report_.joints = FindJoints(character_.skeleton, maps, character_.roles);
    report_.space = FindCharacterSpace(character_, report_.joints);
    report_.face_joints = FaceJoints(character_.skeleton, report_.joints).size();
    CountAll();
    CheckMeshes();
    CheckAtlases();
    CheckPictures();
    CheckSpace();
    CheckJoints();
    CheckRig();
    std::stable_sort(report_.findings.begin(), report_.findings.end(),
                     [](const Finding& a, const Finding& b) { return a.severity < b.severity; });
    return std::move(report_);
  }

 private:
  void Find(Severity severity, const char* code, std::string where, std::string what,
            std::string todo = {}) {
    report_.findings.push_back(
        {severity, code, std::move(where), std::move(what), std::move(todo)});
  }

  void CountAll() {
    std::size_t vertices = 0;
    std::size_t triangles = 0;
    for (const character::Mesh& mesh : character_.meshes) {
      vertices += mesh.vertices.size();
      triangles += mesh.indices.size() / 3;
    }
    report_.counts = {{"joints", static_cast<std::size_t>(character_.skeleton.num_joints())},
                      {"meshes", character_.meshes.size()},
                      {"vertices", vertices},
                      {"triangles", triangles},
                      {"materials", character_.materials.size()},
                      {"pictures", character_.pictures.size()},
                      {"shapes", character_.shapes.size()},
                      {"material binds", character_.material_binds.size()},
                      {"regions", character_.rig.regions.size()},
                      {"wrinkle maps", character_.rig.wrinkle_maps.size()}};
  }

  void CheckMeshes() {
    const bool skinned = std::any_of(notes_.meshes.begin(), notes_.meshes.end(),
                                     [](const character::MeshNotes& mesh) { return mesh.skinned; });
    if (!skinned && has_shape_face_) {
      Find(Severity::kNote, "no-skin", {},
           "no mesh is skinned, so only its blend shapes move the face");
    } else if (!skinned) {
      Find(Severity::kError, "no-skin", {}, "no mesh is skinned, so nothing can fold",
           "bind the mesh to its skeleton and export both");
    }
    for (std::size_t m = 0; m < notes_.meshes.size(); ++m) {
      CheckMesh(character_.meshes[m], notes_.meshes[m]);
    }
    // One line, and not one per mesh.
    if (!notes_.meshes.empty() && !HasUvs()) {
      FindMissingUvs({}, "there are no UVs, which wrinkle maps require", false);
    }
    CheckTangents();
    if (!notes_.idle_shapes.empty()) CheckIdleShapes();
  }

  // Avatars often carry the names of all ARKit shapes, but move only some of them.
  void CheckIdleShapes() {
    constexpr std::size_t kMaxNamed = 5;
    const std::size_t count = notes_.idle_shapes.size();
    std::string names;
    for (std::size_t i = 0; i < std::min(count, kMaxNamed); ++i) {
      names += (i == 0 ? "" : ", ") + notes_.idle_shapes[i];
    }
    if (count > kMaxNamed) names += ", ...";
    Find(Severity::kNote, "idle-shapes", {},
         Count(count, "shape moves", "shapes move") + " nothing visibly: " + names,
         "the import leaves them out");
  }

  void CheckMesh(const character::Mesh& mesh, const character::MeshNotes& notes) {
    const std::string where = "mesh '" + mesh.name + "'";
    if (!notes.has_uvs && HasUvs()) {
      FindMissingUvs(where, "there are no UVs, which wrinkle maps require", true);
    }
    if (notes.unskinned_vertices > 0) {
      Find(Severity::kError, "unskinned-vertices", where,
           Count(notes.unskinned_vertices, "vertex follows", "vertices follow") + " no joint",
           "bind every vertex, or import with --repair to make them follow their neighbours");
    }
    if (const std::size_t flat = CountDegenerateTriangles(mesh); flat > 0) {
      Find(Severity::kNote, "degenerate-triangles", where,
           Count(flat, "triangle has", "triangles have") + " no area", "the import removes them");
    }
    if (notes.unnormalised_vertices > 0) {
      Find(Severity::kWarning, "weights-sum", where,
           "the skin weights of " + Count(notes.unnormalised_vertices, "vertex do", "vertices do") +
               " not sum to 1 (the worst: " + Number(notes.worst_sum) + ")",
           "normalise the weights; the import scales them, so the mesh bends differently than in "
           "its editor");
    }
    if (!notes.has_normals) {
      Find(Severity::kWarning, "normals-missing", where,
           "there are no normals; they are computed, and hard edges are lost",
           "export with normals");
    }
    if (notes.truncated_vertices > 0) {
      Find(Severity::kNote, "weights-truncated", where,
           Count(notes.truncated_vertices, "vertex has", "vertices have") +
               " more than four joints; the strongest four are used");
    }
  }

  // One line, because most exporters leave the tangents of all meshes out.
  void CheckTangents() {
    const auto lacks = [](const character::MeshNotes& mesh) {
      return mesh.has_uvs && !mesh.has_tangents;
    };
    const auto count = std::ranges::count_if(notes_.meshes, lacks);
    if (count == 0) return;
    Find(Severity::kNote, "tangents-missing", {},
         Count(static_cast<std::size_t>(count), "mesh has", "meshes have") +
             " no tangents; they are computed from the UVs");
  }

  [[nodiscard]] bool HasUvs() const {
    return std::ranges::any_of(notes_.meshes, &character::MeshNotes::has_uvs);
  }

  // Meshes with the same material share pictures and therefore UV space. Only those count that maps
  // can be baked for.
  void CheckAtlases() {
    std::map<int, std::vector<int>> meshes_of;
    for (const bool cloth : {false, true}) {
      for (const int m : MeshesOn(character_, cloth)) {
        const auto mesh = static_cast<std::size_t>(m);
        // Already reported by CheckMesh().
        if (mesh < notes_.meshes.size() && !notes_.meshes[mesh].has_uvs) continue;
        meshes_of[character_.meshes[mesh].material].push_back(m);
      }
    }
    std::vector<std::pair<std::string, UvReport>> atlases;
    for (const auto& [material, meshes] : meshes_of) {
      const std::string where =
          material < 0
              ? "mesh '" + character_.meshes[static_cast<std::size_t>(meshes.front())].name + "'"
              : "material '" + character_.materials[static_cast<std::size_t>(material)].name + "'";
      atlases.emplace_back(where, CheckUvs(character_, meshes));
    }
    const bool any_folds =
        std::ranges::any_of(atlases, [](const auto& atlas) { return !atlas.second.no_uvs(); });
    for (const auto& [where, uvs] : atlases) CheckAtlas(where, uvs, any_folds);
  }

  // Parts without UVs move, but stay flat. Figures made of voxels are like that all over: their UVs
  // only choose a colour.
  void FindMissingUvs(const std::string& where, const std::string& what, bool others_fold) {
    Find(
        Severity::kWarning, "uv-missing", where,
        what + (others_fold ? "; it gets no wrinkles" : "; the character moves, but nothing folds"),
        "unwrap it without overlaps, and keep UVs without a picture (gltfpack -kv)");
  }

  void CheckAtlas(const std::string& where, const UvReport& uvs, bool others_fold) {
    if (uvs.no_uvs()) {
      FindMissingUvs(where, "all UVs are at one point", others_fold);
    } else if (uvs.unmapped_triangles > 0) {
      Find(Severity::kWarning, "uv-flat", where,
           Count(uvs.unmapped_triangles, "triangle has", "triangles have") + " no area in the UVs",
           "unwrap these triangles, too");
    }
    if (uvs.overlapping > kTolerableUvOverlap) {
      const std::string place = uvs.example ? ", first at u " + Number(uvs.example->uv.x) + ", v " +
                                                  Number(uvs.example->uv.y) + " (v down)"
                                            : std::string();
      Find(Severity::kWarning, "uv-overlap", where,
           Number(100.0f * uvs.overlapping) + " % of the UV area is used twice" + place,
           "mirrored halves fold alike; give stacked parts, and halves that fold differently, UVs "
           "of "
           "their own");
    }
    if (uvs.outside_triangles > 0) {
      Find(Severity::kNote, "uv-outside", where,
           Count(uvs.outside_triangles, "triangle lies", "triangles lie") +
               " outside the unit square of the UVs; the pictures repeat there");
    }
  }

  void CheckPictures() {
    for (const std::string& missing : notes_.missing_pictures) {
      Find(Severity::kWarning, "picture-missing", {}, "the picture " + missing,
           "put it beside the file as PNG or JPEG, or embed it");
    }
  }

  void CheckSpace() {
    const CharacterSpace& space = report_.space;
    if (!space.axes.empty() && space.rotation != glm::mat3(1.0f)) {
      Find(Severity::kWarning, "up-axis", {}, "the orientation is " + space.axes,
           "expected +Y up, facing +Z; the import rotates the character");
    }
    if (space.scale != 1.0f) {
      Find(Severity::kWarning, "units", {},
           std::string(NameOf(space.kind)) + " is " + Number(space.height) +
               " m high, so the unit is probably " + Number(space.scale) + " m",
           "the import scales it to " + Number(space.height * space.scale) +
               " m (override with --scale); depths of folds are in metres");
    }
  }

  void CheckJoints() {
    if (notes_.nameless_joints > 0) {
      Find(Severity::kWarning, "joint-names", {},
           Count(notes_.nameless_joints, "joint has", "joints have") + " no name",
           "poses address joints by name; name them before exporting");
    }
    // Without any role, a list of all missing roles would not help.
    if (report_.joints.num_roles == 0) {
      // A face of blend shapes folds and moves without them.
      Find(has_shape_face_ ? Severity::kNote : Severity::kWarning, "no-roles", {},
           "neither names nor hierarchy identify the arms, the legs and the head",
           has_shape_face_ ? "streams turn these joints only under their own names; a skeleton map "
                             "helps (docs/SKELETONS.md)"
                           : "write a skeleton map (docs/SKELETONS.md), or a rig by hand "
                             "(docs/RIG.md)");
      FindShapeFace();
      return;
    }
    std::string missing;
    for (const JointRole role :
         {JointRole::kHips, JointRole::kSpine, JointRole::kNeck, JointRole::kHead,
          JointRole::kLeftUpperArm, JointRole::kLeftLowerArm, JointRole::kLeftUpperLeg,
          JointRole::kLeftLowerLeg}) {
      for (const JointRole side : {role, wrinkle::MirrorOf(role)}) {
        if (report_.joints.First(side) == kNoJoint) {
          missing += (missing.empty() ? "" : ", ") + std::string(wrinkle::ToString(side));
        }
        if (side == wrinkle::MirrorOf(role)) break;
      }
    }
    if (!missing.empty()) {
      Find(Severity::kNote, "roles-missing", {}, "no joint is the " + missing,
           "clothing regions of these joints have no driver");
    }
    FindShapeFace();
    if (!has_shape_face_ && report_.face_joints == 0) {
      Find(Severity::kNote, "no-face-joints", {}, "there are no face joints",
           "facial wrinkles then require a tracker's blend shapes (rig 'arkit')");
    }
  }

  void FindShapeFace() {
    if (!has_shape_face_) return FindFewShapes();
    Find(Severity::kNote, "shape-face", {}, "the face has ARKit's blend shapes",
         "the import gives it masks, a rig and wrinkle maps");
  }

  // Avatars often have a few shapes for speech, or none of the names that maps know.
  void FindFewShapes() {
    if (character_.shapes.empty()) return;
    const std::vector<std::string> missing = MissingOfShapeFace(face_);
    Find(Severity::kNote, "few-shapes", {},
         "the shapes of the face do not fold it, because it lacks " + Joined(missing),
         "export the avatar with ARKit's blend shapes; Ready Player Me adds them to an address "
         "that ends with ?morphTargets=ARKit");
  }

  void CheckRig() {
    if (!rig_given_) {
      Find(Severity::kNote, "no-rig", {}, "there is no wrinkle rig, so there are no wrinkles",
           "create a draft with furrow character propose-rig");
      return;
    }
    std::vector<std::string> embedded;
    for (const character::Picture& picture : character_.pictures) embedded.push_back(picture.name);
    character::RigReportOptions options;
    options.skeleton = &character_.skeleton;
    // Streams bring blend shapes, not the character.
    const std::vector<std::string> streamed = wrinkle::BlendShapesOf(character_.rig);
    options.blend_shape_names = streamed;
    options.folder = character_.folder;
    options.embedded_pictures = embedded;
    const character::RigReport rig = character::ReportOnRig(character_.rig, options);
    if (!rig.binding.ok()) {
      Find(Severity::kError, "rig-binding", rig.binding.where(), rig.binding.what(),
           rig.binding.todo());
    }
    for (const std::string& warning : rig.warnings) Find(Severity::kWarning, "rig", "rig", warning);
    for (const wrinkle::WrinkleMap& map : character_.rig.wrinkle_maps) {
      if (!map.normal.empty() || !map.derivative.empty()) continue;
      Find(Severity::kWarning, "rig-picture", "wrinkle map '" + map.name + "'", "it has no picture",
           "create it with furrow bake");
    }
    if (rig.binding.ok()) CheckBake();
  }

  // The checks of `furrow bake` itself, so that it accepts what has no error here.
  void CheckBake() {
    if (character_.rig.regions.empty() || character_.rig.wrinkle_maps.empty()) {
      Find(Severity::kWarning, "rig-poses", {}, "the rig has no regions or no wrinkle maps to bake",
           "add them (docs/RIG.md), or use furrow character propose-rig");
      return;
    }
    const auto poses = CollectBakePoses(character_, {}, face_);
    if (!poses.ok()) {
      const Status& s = poses.status();
      Find(Severity::kError, "rig-poses", s.where(), s.what(), s.todo());
      return;
    }
    std::vector<std::string> warnings;  // faults of the UVs, which CheckAtlas() reports
    const auto bakeable = CheckSurfaces(character_, {}, &warnings);
    if (!bakeable.ok()) {
      const Status& s = bakeable.status();
      Find(Severity::kError, "rig-surface", s.where(), s.what(), s.todo());
      return;
    }
    for (const std::string& map : bakeable->left_out) {
      Find(Severity::kWarning, "rig-surface", {}, map,
           "mark materials as skin or cloth by their names, and unwrap their meshes");
    }
    const bool fed = std::ranges::any_of(poses->poses, [&](const BakePose& pose) {
      return std::ranges::find(bakeable->names, pose.map) != bakeable->names.end();
    });
    if (!fed) {
      Find(Severity::kWarning, "rig-poses", {}, "no pose of the rig folds a surface",
           "add drivers of joints or blend shapes to the rig, or draw the folds (furrow bake "
           "--strokes)");
    }
  }

  const character::Character& character_;
  const character::SourceNotes& notes_;
  const ArkitFace face_;
  const bool has_shape_face_;
  const bool rig_given_;
  CharacterReport report_;
};

}  // namespace

const char* ToString(Severity severity) {
  constexpr std::array kNames = {"error", "warning", "note"};
  return kNames[static_cast<std::size_t>(severity)];
}

std::size_t CharacterReport::Count(Severity severity) const {
  return static_cast<std::size_t>(
      std::count_if(findings.begin(), findings.end(),
                    [&](const Finding& finding) { return finding.severity == severity; }));
}

CharacterReport CheckCharacter(const character::Character& character,
                               const character::SourceNotes& notes, const rig::SkeletonMaps& maps,
                               bool rig_given, const rig::ShapeMatcher& shapes) {
  return Checker(character, notes, shapes, rig_given).Run(maps);
}

std::size_t CountDegenerateTriangles(const character::Mesh& mesh) {
  std::size_t count = 0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) count += IsDegenerate(mesh, i);
  return count;
}

std::size_t DropDegenerateTriangles(character::Mesh* mesh) {
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i + 2 < mesh->indices.size(); i += 3) {
    if (IsDegenerate(*mesh, i)) continue;
    kept.insert(kept.end(), mesh->indices.begin() + static_cast<std::ptrdiff_t>(i),
                mesh->indices.begin() + static_cast<std::ptrdiff_t>(i) + 3);
  }
  const std::size_t dropped = (mesh->indices.size() - kept.size()) / 3;
  mesh->indices = std::move(kept);
  return dropped;
}

}  // namespace furrow::authoring
