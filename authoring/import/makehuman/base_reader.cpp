// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/base_reader.h"

#include <algorithm>
#include <string>
#include <utility>

#include "authoring/import/makehuman/formats/mhskel.h"
#include "authoring/import/makehuman/formats/obj.h"
#include "authoring/import/makehuman/skin_weights.h"
#include "base/files.h"

namespace furrow::authoring {
namespace {

namespace fs = std::filesystem;

constexpr float kMetresPerUnit = 0.1f;  // MakeHuman uses decimetres

// Converts to metres and puts the lowest point of the body on the ground. Helpers do not count,
// since a skirt may hang lower.
Status Place(const fs::path& path, BaseMesh* mesh) {
  const std::vector<std::uint32_t> body = FacesOf(mesh->obj, "body");
  if (body.empty())
    return Status(StatusCode::kSchema, "the mesh has no group 'body'", path.string(),
                  "use MakeHuman's base mesh");
  float ground = mesh->obj.positions[mesh->obj.corners[0].position].y;
  for (const std::uint32_t f : body) {
    const ObjMesh::Face& face = mesh->obj.faces[f];
    for (std::size_t i = 0; i < face.num_corners; ++i)
      ground = std::min(ground,
                        mesh->obj.positions[mesh->obj.corners[face.first_corner + i].position].y);
  }
  mesh->positions = mesh->obj.positions;
  for (glm::vec3& p : mesh->positions) p = (p - glm::vec3(0.0f, ground, 0.0f)) * kMetresPerUnit;
  return {};
}

Status ReadMesh(const fs::path& folder, const MhmSave* save, FittedBase* base) {
  const fs::path path = folder / "3dobjs" / "base.obj";
  const Result<std::string> text = ReadFile(path, kMaxTextFileBytes);
  FURROW_RETURN_IF_ERROR(text);
  Result<ObjMesh> obj = ParseObj(*text, path.string());
  FURROW_RETURN_IF_ERROR(obj);
  base->mesh.obj = std::move(*obj);
  if (save != nullptr) {
    Result<PersonShape> shape = ShapePerson(folder, *save, base->mesh.obj.positions);
    FURROW_RETURN_IF_ERROR(shape);
    base->shape = std::move(*shape);
  }
  return Place(path, &base->mesh);
}

Status ReadSkeleton(const fs::path& folder, FittedBase* base) {
  const fs::path path = folder / "rigs" / "default.mhskel";
  const Result<std::string> text = ReadFile(path, kMaxTextFileBytes);
  FURROW_RETURN_IF_ERROR(text);
  const Result<MhSkeleton> joints = ParseMhskel(*text, path.string());
  FURROW_RETURN_IF_ERROR(joints);
  Result<wrinkle::Skeleton> skeleton = BuildSkeleton(*joints, base->mesh.positions, path.string());
  FURROW_RETURN_IF_ERROR(skeleton);
  base->skeleton = std::move(*skeleton);
  const Result<FaceLandmarks> face = FindFaceLandmarks(base->skeleton);
  if (!face.ok()) return face.status().At(path.string());
  base->face = *face;
  return {};
}

Status ReadWeights(const fs::path& folder, FittedBase* base) {
  const fs::path path = folder / "rigs" / "default_weights.mhw";
  const Result<std::string> text = ReadFile(path, kMaxTextFileBytes);
  FURROW_RETURN_IF_ERROR(text);
  const Result<MhWeights> weights = ParseMhw(*text, path.string());
  FURROW_RETURN_IF_ERROR(weights);
  Result<SkinWeights> skin =
      BindBaseMesh(*weights, base->skeleton, base->mesh.positions.size(), path.string());
  FURROW_RETURN_IF_ERROR(skin);
  base->mesh.skin = std::move(*skin);
  return {};
}

}  // namespace

// The skeleton needs the positions, and the skin weights need the joints, hence the order.
Result<FittedBase> ReadBase(const fs::path& folder, const MhmSave* save) {
  FittedBase base;
  FURROW_RETURN_IF_ERROR(ReadMesh(folder, save, &base));
  FURROW_RETURN_IF_ERROR(ReadSkeleton(folder, &base));
  FURROW_RETURN_IF_ERROR(ReadWeights(folder, &base));
  return base;
}

}  // namespace furrow::authoring
