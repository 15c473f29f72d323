// SPDX-License-Identifier: Apache-2.0
#include "character/package/rig_patch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <glm/geometric.hpp>

#include "base/status.h"
#include "character/mesh/weld.h"
#include "wrinkle/rig/rig_check.h"
#include "wrinkle/skeleton/retarget.h"

namespace furrow::character {
namespace {

constexpr float kLeastSkinWeight = 1e-3f;

// Precision worth writing: a hundredth of a millimetre, a ten-thousandth of a skin weight.
float Rounded(float value, float steps) { return std::round(value * steps) / steps; }

// Skin and cloth wrinkle. If no material is marked as skin, everything except eyes and hair does.
bool Wrinkles(const Character& character, const Mesh& mesh) {
  const auto kind_of = [&](const Mesh& of) {
    return of.material < 0 ? Material::Kind::kOther
                           : character.materials[static_cast<std::size_t>(of.material)].kind;
  };
  const Material::Kind kind = kind_of(mesh);
  if (kind != Material::Kind::kOther) {
    return kind == Material::Kind::kSkin || kind == Material::Kind::kCloth;
  }
  return std::none_of(character.meshes.begin(), character.meshes.end(),
                      [&](const Mesh& other) { return kind_of(other) == Material::Kind::kSkin; });
}

struct Piece {
  const Mesh* mesh = nullptr;
  std::size_t first = 0;  // into the mesh's indices
  float distance = 0.0f;  // from the centroid to the centre
};

// A point of the surface. Vertices on both sides of a UV seam are the same point; vertices of two
// meshes never are.
using Point = std::pair<const Mesh*, std::uint32_t>;

class PatchCutter {
 public:
  PatchCutter(const Character& character, const PatchOptions& options)
      : character_(character), options_(options) {}

  Result<wrinkle::Driver> Run() {
    FURROW_RETURN_IF_ERROR(FindCentre());
    FURROW_RETURN_IF_ERROR(CollectPieces());
    KeepConnected();
    wrinkle::Driver driver;
    driver.name = options_.name;
    driver.kind = wrinkle::Driver::Kind::kStrain;
    strain_ = &driver.strain;
    strain_->direction = options_.direction;
    strain_->full_compression = options_.full_compression;
    strain_->size = wrinkle::SkeletonSize(character_.skeleton);
    for (const Piece& piece : pieces_) AddPiece(piece);
    AddShapes();
    if (strain_->joints.size() < 2 && strain_->shapes.empty()) {
      return Status(StatusCode::kInvalidArgument,
                    "the surface there follows joint '" + strain_->joints.front() +
                        "' alone: no pose can compress it",
                    character_.name, "choose a place that several joints or a shape move");
    }
    MeasureFromBase();
    wrinkle::Rig rig;
    rig.drivers = {driver};
    FURROW_RETURN_IF_ERROR(wrinkle::CheckRigFields(rig));
    return driver;
  }

 private:
  bool IsMeant(const Mesh& mesh) const {
    return options_.mesh.empty() ? Wrinkles(character_, mesh) : mesh.name == options_.mesh;
  }

  // Finds the vertex nearest to the requested point.
  Status FindCentre() {
    float nearest = std::numeric_limits<float>::max();
    bool any = false;
    for (const Mesh& mesh : character_.meshes) {
      if (!IsMeant(mesh)) continue;
      any = true;
      for (const Vertex& vertex : mesh.vertices) {
        const float distance = glm::distance(vertex.position, options_.centre);
        if (distance >= nearest) continue;
        nearest = distance;
        centre_ = vertex.position;
      }
    }
    if (!any) {
      return {StatusCode::kNotFound,
              options_.mesh.empty() ? "the character has neither skin nor cloth"
                                    : "the character has no mesh '" + options_.mesh + "'",
              character_.name};
    }
    // Metres: even a small radius accepts a point within 2 cm of the surface.
    if (nearest <= std::max(options_.radius, 0.02f)) return {};
    char text[96];
    std::snprintf(text, sizeof(text), "no surface at that point; the nearest is at %.4f,%.4f,%.4f",
                  static_cast<double>(centre_.x), static_cast<double>(centre_.y),
                  static_cast<double>(centre_.z));
    return {StatusCode::kNotFound, text, character_.name,
            "positions are in metres, in the rest pose"};
  }

  Status CollectPieces() {
    float nearest = std::numeric_limits<float>::max();
    for (const Mesh& mesh : character_.meshes) {
      if (!IsMeant(mesh)) continue;
      for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        glm::vec3 middle(0.0f);
        for (std::size_t k = 0; k < 3; ++k) middle += At(mesh, i + k).position / 3.0f;
        const float distance = glm::distance(middle, centre_);
        nearest = std::min(nearest, distance);
        if (distance <= options_.radius) pieces_.push_back({&mesh, i, distance});
      }
    }
    std::stable_sort(pieces_.begin(), pieces_.end(),
                     [](const Piece& a, const Piece& b) { return a.distance < b.distance; });
    if (!pieces_.empty()) return {};
    char text[128];
    std::snprintf(text, sizeof text, "no triangle within %.1f mm; the nearest is %.1f mm away",
                  static_cast<double>(1e3f * options_.radius), static_cast<double>(1e3f * nearest));
    return {StatusCode::kNotFound, text, character_.name, "choose a larger radius"};
  }

  static const Vertex& At(const Mesh& mesh, std::size_t index) {
    return mesh.vertices[mesh.indices[index]];
  }

  Point PointAt(const Piece& piece, std::size_t corner) {
    const auto [there, is_new] = welded_.try_emplace(piece.mesh);
    if (is_new) there->second = WeldVertices(*piece.mesh);
    return {piece.mesh, there->second[piece.mesh->indices[piece.first + corner]]};
  }

  // Grows from the nearest triangle over shared corners, nearest first, within a driver's limits.
  void KeepConnected() {
    std::vector<Piece> kept;
    std::set<Point> points;
    std::vector<bool> taken(pieces_.size());
    // Repeats because a far triangle may only connect after a later one was added. Both limits
    // bound the loop.
    for (bool grew = true; grew && kept.size() < wrinkle::kMaxPatchTriangles;) {
      grew = false;
      for (std::size_t i = 0; i < pieces_.size(); ++i) {
        if (taken[i] || kept.size() >= wrinkle::kMaxPatchTriangles) continue;
        std::set<Point> fresh;
        for (std::size_t k = 0; k < 3; ++k) {
          const Point point = PointAt(pieces_[i], k);
          if (!points.contains(point)) fresh.insert(point);
        }
        if (!kept.empty() && fresh.size() == 3) continue;  // not connected yet
        if (points.size() + fresh.size() > wrinkle::kMaxPatchVertices) continue;
        taken[i] = true;
        grew = true;
        kept.push_back(pieces_[i]);
        points.insert(fresh.begin(), fresh.end());
      }
    }
    pieces_ = std::move(kept);
  }

  void AddPiece(const Piece& piece) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [there, is_new] =
          index_.emplace(PointAt(piece, k), static_cast<int>(strain_->vertices.size()));
      if (is_new) AddVertex(At(*piece.mesh, piece.first + k));
      strain_->triangles.push_back(there->second);
    }
  }

  void AddVertex(const Vertex& from) {
    wrinkle::StrainDriver::Vertex& to = strain_->vertices.emplace_back();
    to.position = from.position;
    float sum = 0.0f;
    for (int i = 0; i < 4; ++i) {
      if (from.skin_weights[i] < kLeastSkinWeight) continue;
      to.joints.push_back(JointIndex(from.joints[i]));
      to.skin_weights.push_back(from.skin_weights[i]);
      pull_[from.joints[i]] += from.skin_weights[i];
      sum += from.skin_weights[i];
    }
    // Dropped influences leave a sum below 1.
    for (float& skin_weight : to.skin_weights) skin_weight = Rounded(skin_weight / sum, 1e4f);
  }

  // The targets of the patch's meshes, where they move its vertices.
  void AddShapes() {
    static_assert(wrinkle::kMaxPatchShapes >= kMaxShapes);
    std::map<int, wrinkle::StrainDriver::Shape> shapes;  // by their index in the character
    for (const auto& [mesh, welded] : welded_) {
      for (const MorphTarget& target : mesh->morph_targets) {
        for (const MorphDelta& delta : target.deltas) {
          const auto found = index_.find({mesh, delta.vertex});
          if (found != index_.end()) AddDelta(found->second, delta, &shapes[target.shape]);
        }
      }
    }
    for (auto& [index, shape] : shapes) {
      if (shape.vertices.empty()) continue;
      shape.blend_shape = character_.shapes[static_cast<std::size_t>(index)];
      strain_->shapes.push_back(std::move(shape));
    }
  }

  static void AddDelta(int vertex, const MorphDelta& delta, wrinkle::StrainDriver::Shape* shape) {
    const glm::vec3 move(Rounded(delta.position.x, 1e5f), Rounded(delta.position.y, 1e5f),
                         Rounded(delta.position.z, 1e5f));
    if (move == glm::vec3(0.0f)) return;
    shape->vertices.push_back(vertex);
    shape->deltas.insert(shape->deltas.end(), {move.x, move.y, move.z});
  }

  int JointIndex(int joint) {
    const std::string& name = character_.skeleton.joint_names()[static_cast<std::size_t>(joint)];
    auto& names = strain_->joints;
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return static_cast<int>(found - names.begin());
    names.push_back(name);
    return static_cast<int>(names.size()) - 1;
  }

  // The rig's anchor if it carries the patch, otherwise the joint that moves the patch most.
  int Base() const {
    const int anchor = character_.skeleton.Find(character_.rig.anchor);
    const bool carries = anchor != wrinkle::kNoJoint &&
                         std::all_of(pull_.begin(), pull_.end(), [&](const auto& pull) {
                           return character_.skeleton.IsAncestor(anchor, pull.first);
                         });
    if (carries) return anchor;
    return std::max_element(pull_.begin(), pull_.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
  }

  void MeasureFromBase() {
    const int base = Base();
    strain_->joint = character_.skeleton.joint_names()[static_cast<std::size_t>(base)];
    const glm::vec3 origin = character_.skeleton.rest_model()[static_cast<std::size_t>(base)][3];
    for (wrinkle::StrainDriver::Vertex& vertex : strain_->vertices) {
      for (int axis = 0; axis < 3; ++axis) {
        vertex.position[axis] = Rounded(vertex.position[axis] - origin[axis], 1e5f);
      }
    }
  }

  const Character& character_;
  const PatchOptions& options_;
  glm::vec3 centre_{0.0f};
  std::vector<Piece> pieces_;
  wrinkle::StrainDriver* strain_ = nullptr;
  std::map<const Mesh*, std::vector<std::uint32_t>> welded_;
  std::map<Point, int> index_;
  std::map<int, float> pull_;  // joint -> sum of its skin weights
};

// The kind of material that a region's maps are drawn on; kOther for any.
Material::Kind SurfaceOf(const wrinkle::Rig& rig, const wrinkle::Region& region) {
  using Surface = wrinkle::WrinkleMap::Surface;
  for (const wrinkle::Feed& feed : region.feeds) {
    for (const wrinkle::WrinkleMap& map : rig.wrinkle_maps) {
      if (map.name != feed.map || map.surface == Surface::kAny) continue;
      return map.surface == Surface::kCloth ? Material::Kind::kCloth : Material::Kind::kSkin;
    }
  }
  return Material::Kind::kOther;
}

bool IsKind(const Character& character, const Mesh& mesh, Material::Kind kind) {
  return kind == Material::Kind::kOther || mesh.material < 0 ||
         character.materials[static_cast<std::size_t>(mesh.material)].kind == kind;
}

}  // namespace

Result<wrinkle::Driver> CutPatch(const Character& character, const PatchOptions& options) {
  return PatchCutter(character, options).Run();
}

Result<glm::vec3> JointPosition(const Character& character, const std::string& joint) {
  const int index = character.skeleton.Find(joint);
  if (index == wrinkle::kNoJoint) {
    return Status(StatusCode::kNotFound, "the skeleton has no joint '" + joint + "'",
                  character.name);
  }
  return glm::vec3(character.skeleton.rest_model()[static_cast<std::size_t>(index)][3]);
}

Result<glm::vec3> RegionPosition(const Character& character, const std::string& region) {
  for (const wrinkle::Region& candidate : character.rig.regions) {
    if (candidate.name != region) continue;
    const Material::Kind kind = SurfaceOf(character.rig, candidate);
    const int picture = character.FindRigPicture(candidate.mask.texture);
    if (picture < 0) {
      return Status(StatusCode::kNotFound, "region '" + region + "' has no mask picture",
                    character.name, "give the place with --around or --joint");
    }
    std::vector<glm::vec3> inside;
    glm::vec3 sum(0.0f);
    for (const Mesh& mesh : character.meshes) {
      if (!Wrinkles(character, mesh) || !IsKind(character, mesh, kind)) continue;
      for (const Vertex& vertex : mesh.vertices) {
        const Picture& mask = character.pictures[static_cast<std::size_t>(picture)];
        if (ChannelAt(mask, vertex.uv, candidate.mask.channel) < 0.5f) continue;
        inside.push_back(vertex.position);
        sum += vertex.position;
      }
    }
    // The centroid of a bent surface lies below it, perhaps nearer to another surface, so snap to
    // the surface again.
    const glm::vec3 middle = sum / static_cast<float>(std::max<std::size_t>(inside.size(), 1));
    const auto nearest =
        std::min_element(inside.begin(), inside.end(), [&](const glm::vec3& a, const glm::vec3& b) {
          return glm::distance(a, middle) < glm::distance(b, middle);
        });
    if (nearest != inside.end()) return *nearest;
    return Status(StatusCode::kNotFound, "the mask of region '" + region + "' covers no vertex",
                  character.name, "give the place with --around or --joint");
  }
  return Status(StatusCode::kNotFound, "the rig has no region '" + region + "'", character.name);
}

}  // namespace furrow::character
