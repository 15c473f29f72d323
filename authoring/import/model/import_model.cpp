// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/import_model.h"

#include <string_view>
#include <utility>

#include "authoring/bake/surface/uv_check.h"
#include "authoring/import/model/draco_call.h"
#include "authoring/import/model/foreign_model.h"
#include "authoring/shapes/contained_jaw.h"
#include "base/ascii.h"
#include "base/files.h"
#include "base/status.h"
#include "character/package/package.h"
#include "gltf/limits.h"

namespace furrow::authoring {
namespace {

namespace fs = std::filesystem;
using wrinkle::JointRoles;

std::string Extension(const fs::path& path) { return AsciiLower(path.extension().string()); }

// The content counts first: binary glTF may have any extension.
bool IsGltf(std::string_view bytes, const std::string& extension) {
  return bytes.starts_with("glTF") || extension == ".glb" || extension == ".gltf" ||
         extension == ".vrm";
}

// Reads a model from its bytes. `where` of an error is a field.
Status Parse(std::string_view bytes, const fs::path& path, const rig::SkeletonMaps& maps,
             OpenedModel* model) {
  const gltf::DracoDecoder draco = DracoInHelper();
  const character::ReadOptions options{
      .lenient = true,
      .notes = &model->notes,
      .draco = &draco,
      .is_eye_name = [&maps](const std::string& name) { return maps.KnowEye(name); }};
  const std::string extension = Extension(path);
  std::string converted;
  if (!IsGltf(bytes, extension)) {
    Result<ForeignModel> foreign = ReadWithAssimp(bytes, extension);
    FURROW_RETURN_IF_ERROR(foreign);
    model->remarks = std::move(foreign->remarks);
    converted = std::move(foreign->glb);
    bytes = converted;
  }
  Result<character::Character> character =
      character::ParseCharacter(bytes, path.parent_path(), options);
  FURROW_RETURN_IF_ERROR(character);
  model->character = std::move(*character);
  return BringToRestPose(&model->character);
}

// One line: where, what, and in brackets what to do.
std::string Sentence(const Finding& finding) {
  return (finding.where.empty() ? "" : finding.where + ": ") + finding.what +
         (finding.todo.empty() ? "" : " (" + finding.todo + ")");
}

// Removes triangles without area, and meshes that have no others.
void DropDegenerates(OpenedModel* model) {
  std::size_t dropped = 0;
  std::vector<character::Mesh> kept;
  std::vector<character::MeshNotes> notes;
  for (std::size_t m = 0; m < model->character.meshes.size(); ++m) {
    character::Mesh& mesh = model->character.meshes[m];
    dropped += DropDegenerateTriangles(&mesh);
    if (mesh.indices.empty()) continue;
    kept.push_back(std::move(mesh));
    notes.push_back(model->notes.meshes[m]);
  }
  model->character.meshes = std::move(kept);
  model->notes.meshes = std::move(notes);
  if (dropped > 0) {
    model->remarks.push_back("removed triangles without area: " + std::to_string(dropped));
  }
}

// Materials without UVs take no wrinkle maps; all their texels would be one.
void RestWithoutUvs(OpenedModel* model) {
  character::Character& character = model->character;
  for (std::size_t material = 0; material < character.materials.size(); ++material) {
    std::vector<int> meshes;
    bool has_uvs = true;
    for (std::size_t m = 0; m < character.meshes.size(); ++m) {
      if (character.meshes[m].material != static_cast<int>(material)) continue;
      meshes.push_back(static_cast<int>(m));
      has_uvs &= model->notes.meshes[m].has_uvs;
    }
    if (meshes.empty()) continue;
    if (!has_uvs || CheckUvs(character, meshes).no_uvs()) {
      character.materials[material].wrinkles = false;
    }
  }
}

// The lenient reader has already bound these vertices. Without --repair, they are an error.
void BindUnskinned(OpenedModel* model) {
  int bound = 0;
  for (character::MeshNotes& notes : model->notes.meshes)
    bound += std::exchange(notes.unskinned_vertices, 0);
  if (bound == 0) return;
  model->remarks.push_back("unskinned vertices that now follow their neighbours: " +
                           std::to_string(bound));
}

}  // namespace

Result<OpenedModel> OpenModel(const fs::path& path, const rig::SkeletonMaps& maps) {
  const Result<std::string> bytes = ReadFile(path, gltf::kMaxFileBytes);
  FURROW_RETURN_IF_ERROR(bytes);
  OpenedModel model;
  if (Status status = Parse(*bytes, path, maps, &model); !status.ok())
    return status.Within(path.string());
  if (model.character.name.empty()) model.character.name = path.stem().string();
  return model;
}

Result<ImportedModel> ImportModel(const fs::path& path, const rig::SkeletonMaps& maps,
                                  const ModelOptions& options) {
  Result<OpenedModel> opened = OpenModel(path, maps);
  FURROW_RETURN_IF_ERROR(opened);
  DropDegenerates(&*opened);
  if (options.repair) BindUnskinned(&*opened);
  const CharacterReport report =
      CheckCharacter(opened->character, opened->notes, maps, false, options.shapes);
  ImportedModel imported;
  imported.remarks = std::move(opened->remarks);
  imported.warnings = opened->character.warnings;
  for (const Finding& finding : report.findings) {
    // The import corrects these two itself, so they are remarks and not warnings.
    const bool settled = finding.code == "up-axis" || finding.code == "units";
    if (finding.severity == Severity::kError) {
      return Status(StatusCode::kUnsupported, finding.what,
                    path.string() + (finding.where.empty() ? "" : ": " + finding.where),
                    finding.todo);
    }
    auto& list =
        settled || finding.severity == Severity::kNote ? imported.remarks : imported.warnings;
    if (finding.code != "no-rig" && finding.code != "shape-face") list.push_back(Sentence(finding));
  }
  imported.remarks.push_back("the joints have " + Describe(report.joints));
  RestWithoutUvs(&*opened);
  const float scale = options.scale.value_or(report.space.scale);
  // After the check, which reports the space of the file as it is.
  if (report.space.rotation != glm::mat3(1.0f) || scale != 1.0f) {
    if (Status s = MoveToSpace(report.space.rotation, scale, &opened->character); !s.ok()) {
      return s.Within(path.string());
    }
  }
  if (NoteContainedJaw(options.shapes, &opened->character)) {
    imported.remarks.emplace_back(
        "mouthClose opens the jaw itself, so a closed mouth takes jawOpen back by as much");
  }
  imported.character = std::move(opened->character);
  // The package keeps them, because those who play it have neither the map nor the guess.
  imported.character.roles = report.joints.num_roles > 0 ? report.joints.roles : JointRoles();
  imported.look_at = opened->notes.look_at;
  return imported;
}

}  // namespace furrow::authoring
