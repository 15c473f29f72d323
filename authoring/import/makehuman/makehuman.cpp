// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/makehuman.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include <glm/geometric.hpp>

#include "authoring/bake/bake.h"
#include "authoring/bake/bake_pictures.h"
#include "authoring/bake/bake_poses.h"
#include "authoring/import/makehuman/base_reader.h"
#include "authoring/import/makehuman/body_parts.h"
#include "authoring/import/makehuman/face/face_folds.h"
#include "authoring/import/makehuman/face/prop_paint.h"
#include "authoring/import/makehuman/face/skin_paint.h"
#include "authoring/import/makehuman/formats/mhm.h"
#include "authoring/import/makehuman/hair.h"
#include "authoring/import/makehuman/own_parts.h"
#include "authoring/import/makehuman/proxy.h"
#include "authoring/import/makehuman/save/asset_library.h"
#include "authoring/import/makehuman/save/bare_body.h"
#include "authoring/import/makehuman/save/person_look.h"
#include "authoring/import/makehuman/saved_parts.h"
#include "authoring/paint/surface_texels.h"
#include "base/data_dir.h"
#include "base/files.h"
#include "base/status.h"
#include "base/text.h"
#include "character/package/package.h"
#include "rig/rig_check.h"
#include "rig/rig_file.h"
#include "wrinkle/solver/solver.h"

namespace furrow::authoring {
namespace {

namespace fs = std::filesystem;

float AreaOf(const character::Mesh& mesh) {
  float area = 0.0f;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const glm::vec3& a = mesh.vertices[mesh.indices[i]].position;
    area += 0.5f * glm::length(glm::cross(mesh.vertices[mesh.indices[i + 1]].position - a,
                                          mesh.vertices[mesh.indices[i + 2]].position - a));
  }
  return area;
}

// One run of the importer: reads, fits, cuts and paints.
class MakeHumanImport {
 public:
  MakeHumanImport(const fs::path& folder, const ImportOptions& options)
      : folder_(folder), options_(options) {}

  Result<character::Character> Run(ImportReport* report) {
    if (options_.texture_size < 64 || options_.texture_size > 4096)
      return Status(StatusCode::kInvalidArgument, "texture_size is " +
                                                      std::to_string(options_.texture_size) +
                                                      "; it must be in [64, 4096]");
    character_.name = "makehuman";
    using Step = Status (MakeHumanImport::*)();
    for (const Step step :
         {&MakeHumanImport::ReadSave, &MakeHumanImport::FitBase, &MakeHumanImport::ReadParts,
          &MakeHumanImport::ReadRig, &MakeHumanImport::BuildBody, &MakeHumanImport::BuildParts,
          &MakeHumanImport::BakeMaps}) {
      FURROW_RETURN_IF_ERROR((this->*step)());
    }
    FinishReport();
    if (report != nullptr) *report = std::move(report_);
    return std::move(character_);
  }

 private:
  Status ReadSave() {
    if (options_.save.empty()) return {};
    const Result<std::string> text = ReadFile(options_.save, kMaxMhmBytes);
    FURROW_RETURN_IF_ERROR(text);
    Result<MhmSave> save = ParseMhm(*text, options_.save.string());
    FURROW_RETURN_IF_ERROR(save);
    save_ = std::move(*save);
    Append(save_->warnings);
    character_.name = save_->name.empty() ? options_.save.stem().string() : save_->name;
    if (!save_->skeleton.empty() && fs::path(save_->skeleton).stem() != "default")
      report_.warnings.push_back("the skeleton '" + save_->skeleton +
                                 "' is not imported; the default rig, which has the joints of "
                                 "the face, is used instead (" +
                                 std::string(kToKeepIt) + ")");
    return {};
  }

  Status FitBase() {
    Result<FittedBase> base = ReadBase(folder_, save_ ? &*save_ : nullptr);
    FURROW_RETURN_IF_ERROR(base);
    base_ = std::move(base->mesh);
    face_ = base->face;
    character_.skeleton = std::move(base->skeleton);
    for (const glm::mat4& model : character_.skeleton.rest_model())
      character_.inverse_bind_matrices.push_back(glm::inverse(model));
    if (!save_) return {};
    Append(base->shape.warnings);
    report_.notes.push_back(
        "shape: " + Counted(static_cast<std::uint64_t>(base->shape.targets), "target") + ", " +
        Counted(static_cast<std::uint64_t>(base->shape.modifiers), "modifier") +
        " besides the macros");
    return {};
  }

  // The folder of the garment: the requested one, or the first by name.
  Result<fs::path> FindGarment() {
    const fs::path clothes = folder_ / "clothes";
    if (!options_.clothes.empty())
      return clothes / options_.clothes / (options_.clothes + ".mhclo");
    std::vector<fs::path> found;
    std::error_code error;
    for (fs::directory_iterator it(clothes, error), end; !error && it != end; it.increment(error)) {
      const fs::path file = it->path() / (it->path().filename().string() + ".mhclo");
      std::error_code ignored;
      if (fs::is_regular_file(file, ignored)) found.push_back(file);
    }
    if (found.empty()) return fs::path();
    return *std::min_element(found.begin(), found.end());
  }

  Status ReadParts() {
    if (save_) return ReadPartsOfSave();
    const Result<fs::path> path = FindGarment();
    FURROW_RETURN_IF_ERROR(path);
    if (path->empty()) {
      report_.warnings.push_back((folder_ / "clothes").string() +
                                 " contains no clothes; the body stays bare");
      return {};
    }
    Result<Proxy> garment = ReadProxy(*path, base_.positions.size());
    FURROW_RETURN_IF_ERROR(garment);
    SavedPart part;
    part.kind = "clothes";
    part.painted = true;
    part.proxy = std::move(*garment);
    parts_.push_back(std::move(part));
    return {};
  }

  Status ReadPartsOfSave() {
    std::vector<fs::path> folders{folder_};
    folders.insert(folders.end(), options_.asset_folders.begin(), options_.asset_folders.end());
    AssetLibrary library(std::move(folders));
    parts_ = ReadSavedParts(*save_, &library, base_.positions.size(), options_.texture_size,
                            &report_.warnings);
    skin_picture_ = ReadSavedSkin(*save_, library, &report_.warnings);
    std::string names;
    for (const SavedPart& part : parts_) {
      names += (names.empty() ? "" : ", ") + part.kind + " '" + part.name + "'";
    }
    report_.notes.push_back("parts: " + (names.empty() ? "none" : names));
    report_.notes.push_back(skin_picture_ ? "skin: the picture of " + save_->skin_material
                                          : "skin: painted");
    return {};
  }

  Status ReadRig() {
    fs::path path = options_.rig;
    if (path.empty()) {
      Result<fs::path> found = FindDataFile("rigs/makehuman.json");
      FURROW_RETURN_IF_ERROR(found);
      path = std::move(*found);
    }
    const Result<std::string> text = ReadFile(path, kMaxTextFileBytes);
    FURROW_RETURN_IF_ERROR(text);
    Result<wrinkle::Rig> rig =
        rig::ParseRig(*text, path.string(), folder_ / "poseunits", options_.poses);
    FURROW_RETURN_IF_ERROR(rig);
    const Result<wrinkle::RigBinding> binding =
        wrinkle::RigBinding::Create(*rig, character_.skeleton, {});
    if (!binding.ok()) return binding.status().At(path.string());
    character_.rig = std::move(*rig);
    return {};
  }

  // Pictures are painted per texel of the finished mesh, so the mesh comes first.
  Status BuildBody() {
    const int size = options_.texture_size;
    character::Material skin{
        .name = "skin", .kind = character::Material::Kind::kSkin, .roughness = 0.5f};
    const bool hide = !save_ || save_->clothes_hide_faces;
    std::vector<UvMove> moves;
    character_.meshes.push_back(BuildSkin(base_, character_.skeleton,
                                          hide ? HiddenBy(parts_) : std::vector<bool>(), 0,
                                          &report_.hidden_faces, &moves));
    const std::vector<SurfaceTexel> texels = RasterizeSurface(character_.meshes.back(), size, size);
    skin.base_colour_texture = AddPicture(SkinColours(texels, moves), &character_);
    skin.normal_texture = AddPicture(PaintMakeHumanSkinNormals(texels, face_, size), &character_);
    character_.materials.push_back(skin);
    FaceMasks masks = PaintFaceMasks(texels, face_, size);
    AddPicture(std::move(masks.first), &character_);
    AddPicture(std::move(masks.second), &character_);
    strokes_ = FaceStrokes(face_, texels);
    BuildOwnParts();
    return {};
  }

  void BuildOwnParts() {
    const PartSource source{
        base_, face_, Look(), options_.texture_size, &character_, &report_.warnings};
    if (!HasKind(parts_, "eyes")) AddOwnEyes(source);
    if (!HasKind(parts_, "teeth")) AddOwnTeeth(source);
    if (!HasKind(parts_, "tongue")) AddOwnTongue(source);
    if (Grows("hair")) AddOwnHair(source);
    if (Grows("eyelashes")) AddOwnLashes(source);
  }

  // True if the import makes the part itself: the save has it, but the folder lacks it.
  bool Grows(std::string_view kind) const {
    if (!save_) return true;
    const bool named = std::any_of(save_->parts.begin(), save_->parts.end(),
                                   [&](const MhmSave::Part& part) { return part.kind == kind; });
    return named && !HasKind(parts_, kind);
  }

  // Scalp and brows are painted unless the save has other ones.
  SkinLook Look() const {
    SkinLook look;
    if (!save_) return look;
    look.scalp = HasKind(parts_, "hair") || Grows("hair");
    look.brows = !HasKind(parts_, "eyebrows");
    const PersonLook person = LookOf(*save_);
    look.old = person.old;
    look.asian = person.asian;
    look.african = person.african;
    return look;
  }

  character::Picture SkinColours(const std::vector<SurfaceTexel>& texels,
                                 const std::vector<UvMove>& moves) const {
    const int size = options_.texture_size;
    if (!skin_picture_) return PaintMakeHumanSkin(texels, face_, Look(), size);
    character::Picture picture = MoveSkinPicture(*skin_picture_, texels, moves, size);
    if (Grows("eyebrows")) PaintMakeHumanBrows(texels, face_, Look(), &picture);
    return picture;
  }

  // Clothes hide what is worn under them.
  Status BuildParts() {
    const bool hide = save_ && save_->clothes_hide_faces;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const SavedPart& part = parts_[i];
      const bool layered = hide && part.kind == "clothes";
      const Result<FittedProxy> fitted =
          FitProxy(part.proxy, base_, part.name.empty() ? part.kind : part.name,
                   layered ? HiddenBy(std::span(parts_).subspan(i + 1)) : std::vector<bool>());
      FURROW_RETURN_IF_ERROR(fitted);
      report_.unweighted_vertices += fitted->unweighted;
      report_.truncated_vertices += fitted->truncated;
      if (fitted->mesh.indices.empty()) continue;  // hidden under other clothes
      character::Mesh mesh = fitted->mesh;
      const bool cloth = part.painted && part.kind == "clothes";
      mesh.material = cloth ? AddPaintedCloth(mesh) : AddLook(part);
      character_.meshes.push_back(std::move(mesh));
    }
    return {};
  }

  int AddPaintedCloth(const character::Mesh& mesh) {
    const int size = options_.texture_size;
    const std::vector<SurfaceTexel> texels = RasterizeSurface(mesh, size, size);
    character::Material cloth{
        .name = "cloth", .kind = character::Material::Kind::kCloth, .roughness = 0.85f};
    cloth.double_sided = true;  // cuffs and collars show their inside
    cloth.base_colour_texture = AddPicture(PaintCloth(texels, Waist(), size), &character_);
    cloth.normal_texture = AddPicture(PaintWeaveNormals(texels, size), &character_);
    return AddMaterial(cloth, &character_);
  }

  int AddLook(const SavedPart& part) {
    character::Material material = MaterialOf(part);
    if (part.painted)
      material.base_colour_texture = AddPicture(
          PaintHairStrands(Look(), std::max(options_.texture_size / 2, 64)), &character_);
    if (part.colour) material.base_colour_texture = AddPicture(*part.colour, &character_);
    if (part.normal) material.normal_texture = AddPicture(*part.normal, &character_);
    return AddMaterial(material, &character_);
  }

  // Where the spine leaves the pelvis; half the body's height where there is no such joint.
  float Waist() const {
    const int joint = character_.skeleton.Find("spine04");
    if (joint == wrinkle::kNoJoint) return 0.5f * face_.crown.y;
    return character_.skeleton.rest_model()[static_cast<std::size_t>(joint)][3].y;
  }

  // All cloth shares one map, so that garments with UVs of their own would show each other's folds.
  // Without clothes, the rig's maps of cloth go.
  void ChooseWrinkledGarment() {
    float most = -1.0f;
    int chosen = -1;
    for (const character::Mesh& mesh : character_.meshes) {
      character::Material& material = character_.materials[static_cast<std::size_t>(mesh.material)];
      if (material.kind != character::Material::Kind::kCloth) continue;
      material.wrinkles = false;
      const float area = AreaOf(mesh);
      if (area <= most) continue;
      most = area;
      chosen = mesh.material;
    }
    if (chosen < 0) return RemoveClothMaps(&character_.rig);
    character_.materials[static_cast<std::size_t>(chosen)].wrinkles = true;
  }

  // Wrinkle maps: strokes where the face's folds are known, strain elsewhere and on the cloth.
  Status BakeMaps() {
    ChooseWrinkledGarment();
    for (const wrinkle::Region& region : character_.rig.regions) UsePicture(region.mask.texture);
    // A rig of another's making may do without the face's maps.
    std::erase_if(strokes_, [this](const BakeStroke& stroke) {
      const auto& maps = character_.rig.wrinkle_maps;
      return std::none_of(maps.begin(), maps.end(), [&](const wrinkle::WrinkleMap& map) {
        return map.name == stroke.maps.front();
      });
    });
    const Result<CollectedPoses> poses = CollectBakePoses(character_);
    FURROW_RETURN_IF_ERROR(poses);
    BakeOptions options;
    options.size = static_cast<int>(std::bit_floor(static_cast<unsigned>(options_.texture_size)));
    // Joints that only turn squeeze the cheeks more than muscles do: little of it is believed.
    options.skin.share = 0.2f;
    options.skin.max_compression = 0.3f;
    options.skin.threshold = 0.08f;
    const Result<BakedMaps> baked =
        Bake(character_, poses->poses, strokes_, options, options_.progress);
    FURROW_RETURN_IF_ERROR(baked);
    FURROW_RETURN_IF_ERROR(AddMapPictures(*baked));
    LeaveFolds();
    return {};
  }

  Status AddMapPictures(const BakedMaps& baked) {
    for (wrinkle::WrinkleMap& map : character_.rig.wrinkle_maps) {
      for (const BakedMap& from : baked.maps) {
        if (from.map != map.name) continue;
        Result<std::vector<character::Picture>> pictures = WrinkleMapPictures(from, map);
        FURROW_RETURN_IF_ERROR(pictures);
        for (character::Picture& picture : *pictures) AddPicture(std::move(picture), &character_);
      }
      for (const std::string* name :
           {&map.normal, &map.derivative, &map.height, &map.colour, &map.cavity}) {
        UsePicture(*name);
      }
    }
    return {};
  }

  // Half of the folds of an old face stay when it rests.
  void LeaveFolds() {
    const float old = Look().old;
    if (old <= 0.0f) return;
    for (const wrinkle::WrinkleMap& map : character_.rig.wrinkle_maps) {
      const int folds = character_.FindRigPicture(map.normal);
      if (folds < 0 || map.surface != wrinkle::WrinkleMap::Surface::kSkin) continue;
      AddRestFolds(
          character_.pictures[static_cast<std::size_t>(folds)], 0.5f * old * old,
          &character_
               .pictures[static_cast<std::size_t>(character_.materials.front().normal_texture)]);
    }
  }

  // A picture that the rig names is one of those made here.
  void UsePicture(const std::string& name) {
    if (name.empty() || character_.FindRigPicture(name) >= 0) return;
    for (std::size_t i = 0; i < character_.pictures.size(); ++i) {
      if (character_.pictures[i].name != name) continue;
      character_.rig_pictures.emplace_back(name, static_cast<int>(i));
      return;
    }
    report_.warnings.push_back("the rig names the picture '" + name +
                               "', which this import does not create");
  }

  void FinishReport() {
    report_.joints = character_.skeleton.num_joints();
    report_.unweighted_vertices += base_.skin.unweighted;
    report_.truncated_vertices += base_.skin.truncated;
    for (const character::Mesh& mesh : character_.meshes) {
      report_.vertices += static_cast<int>(mesh.vertices.size());
      report_.triangles += static_cast<int>(mesh.indices.size() / 3);
    }
    if (report_.unweighted_vertices > 0)
      report_.warnings.push_back(std::to_string(report_.unweighted_vertices) +
                                 " vertices have no weights and follow the root joint");
  }

  void Append(const std::vector<std::string>& warnings) {
    report_.warnings.insert(report_.warnings.end(), warnings.begin(), warnings.end());
  }

  fs::path folder_;
  const ImportOptions& options_;
  BaseMesh base_;
  std::optional<MhmSave> save_;
  std::vector<SavedPart> parts_;
  std::optional<character::Picture> skin_picture_;
  FaceLandmarks face_;
  std::vector<BakeStroke> strokes_;
  character::Character character_;
  ImportReport report_;
};

}  // namespace

Result<character::Character> ImportMakeHuman(const fs::path& folder, const ImportOptions& options,
                                             ImportReport* report) {
  return MakeHumanImport(folder, options).Run(report);
}

}  // namespace furrow::authoring
