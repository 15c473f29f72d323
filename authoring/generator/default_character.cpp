// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/default_character.h"

#include <algorithm>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "authoring/bake/strokes_file.h"
#include "authoring/generator/blend_shapes/blend_shape_face.h"
#include "authoring/generator/body/body_shape.h"
#include "authoring/generator/body/body_skeleton.h"
#include "authoring/generator/clothes/cloth_masks.h"
#include "authoring/generator/clothes/cloth_texture.h"
#include "authoring/generator/clothes/clothes.h"
#include "authoring/generator/head/face_parts.h"
#include "authoring/generator/head/hair_mesh.h"
#include "authoring/generator/head/head_skin.h"
#include "authoring/generator/head/lid_strips.h"
#include "authoring/generator/head/skinning.h"
#include "authoring/generator/mesh/mesh_tools.h"
#include "authoring/generator/recordings/recording_bvh.h"
#include "authoring/generator/recordings/recordings.h"
#include "authoring/generator/textures/skin_colour.h"
#include "authoring/generator/textures/skin_relief.h"
#include "authoring/generator/textures/textures.h"
#include "authoring/generator/textures/wrinkle_maps.h"
#include "authoring/paint/hair_strands.h"
#include "authoring/paint/strokes.h"
#include "authoring/paint/surface_texels.h"
#include "authoring/paint/teeth.h"
#include "base/files.h"
#include "base/status.h"
#include "character/package/package.h"
#include "rig/rig_file.h"

namespace furrow::authoring {
namespace {

// Returns the index by which materials refer to the picture.
int AddPicture(character::Character* character, character::Picture picture) {
  character->pictures.push_back(std::move(picture));
  return static_cast<int>(character->pictures.size()) - 1;
}

// The rig finds the picture by name.
void AddRigPicture(character::Character* character, const char* name, character::Picture picture) {
  picture.name = name;
  const int index = AddPicture(character, std::move(picture));
  character->rig_pictures.emplace_back(name, index);
}

void AddMesh(character::Character* character, character::Mesh mesh, character::Material material) {
  mesh.material = static_cast<int>(character->materials.size());
  character->materials.push_back(std::move(material));
  character->meshes.push_back(std::move(mesh));
}

character::Material MakeMaterial(const char* name, character::Material::Kind kind,
                                 float roughness) {
  character::Material material;
  material.name = name;
  material.kind = kind;
  material.roughness = roughness;
  return material;
}

character::Mesh SkinnedPart(const wrinkle::Skeleton& skeleton, HeadMesh part) {
  SkinHead(skeleton, &part);
  return std::move(part.mesh);
}

// Head and hands are one mesh and one atlas, so that they share pictures and the skin shader.
// Masks, roughness and thickness vary slowly and need fewer texels.
void AddSkin(const CharacterOptions& options, const HeadShape& shape, const BodyShape& body,
             character::Character* character) {
  character::Mesh skin = SkinnedPart(character->skeleton, MakeHeadSkin(shape, options.level));
  AddHands(body, &skin);
  FinishSurface(&skin);
  const int size = options.texture_size;
  character::Material material = MakeMaterial("skin", character::Material::Kind::kSkin, 1.0f);
  material.base_colour_texture = AddPicture(character, PaintSkinColour(skin, shape, size));
  material.normal_texture = AddPicture(character, PaintSkinNormals(skin, shape, size));
  material.roughness_texture = AddPicture(character, PaintSkinRoughness(skin, size / 2));
  material.thickness = kFullThickness;
  material.thickness_texture = AddPicture(character, PaintSkinThickness(skin, shape, size / 4));
  AddRigPicture(character, "face_masks_a", PaintMasksA(skin, size / 2));
  AddRigPicture(character, "face_masks_b", PaintMasksB(skin, size / 2));
  AddMesh(character, std::move(skin), std::move(material));
}

// Parts without wrinkles, each with its own material.
void AddHeadParts(const CharacterOptions& options, const HeadShape& shape,
                  character::Character* character) {
  character::Material eyes = MakeMaterial("eyes", character::Material::Kind::kEye, 0.12f);
  eyes.base_colour_texture = AddPicture(character, PaintEyes(options.texture_size / 2));
  AddMesh(character, SkinnedPart(character->skeleton, MakeEyes()), std::move(eyes));

  character::Mesh hair = SkinnedPart(character->skeleton, MakeHair(shape));
  character::Material strands = MakeMaterial("hair", character::Material::Kind::kHair, 0.68f);
  strands.double_sided = true;
  strands.alpha_cutoff = kStrandCutoff;
  HairPictures pictures = PaintHair(hair, options.face, options.texture_size);
  strands.base_colour_texture = AddPicture(character, std::move(pictures.colour));
  strands.normal_texture = AddPicture(character, std::move(pictures.normals));
  AddMesh(character, std::move(hair), std::move(strands));

  character::Material lashes = MakeMaterial("lashes", character::Material::Kind::kHair, 0.7f);
  lashes.base_colour = glm::vec4(0.012f, 0.008f, 0.006f, 1.0f);
  lashes.base_colour_texture = AddPicture(character, PaintLash());
  lashes.alpha_cutoff = kStrandCutoff;
  lashes.double_sided = true;
  AddMesh(character, SkinnedPart(character->skeleton, MakeLashes(shape)), std::move(lashes));

  character::Material tears = MakeMaterial("tears", character::Material::Kind::kEye, 0.1f);
  tears.base_colour = glm::vec4(0.48f, 0.27f, 0.23f, 1.0f);  // of the flesh below
  AddMesh(character, SkinnedPart(character->skeleton, MakeTears(shape)), std::move(tears));

  character::Material shades = MakeMaterial("lid_shades", character::Material::Kind::kShade, 1.0f);
  shades.base_colour_texture = AddPicture(character, PaintLidShade());
  AddMesh(character, SkinnedPart(character->skeleton, MakeLidShades(shape)), std::move(shades));

  character::Material teeth = MakeMaterial("teeth", character::Material::Kind::kOther, 0.3f);
  character::Mesh rows = SkinnedPart(character->skeleton, MakeTeeth());
  teeth.base_colour_texture =
      AddPicture(character, PaintTeeth(AgeShare(options.face), options.texture_size / 2));
  AddMesh(character, std::move(rows), std::move(teeth));

  character::Material tongue = MakeMaterial("tongue", character::Material::Kind::kOther, 0.4f);
  tongue.base_colour = glm::vec4(0.36f, 0.085f, 0.08f, 1.0f);
  AddMesh(character, SkinnedPart(character->skeleton, MakeTongue()), std::move(tongue));
}

void AddClothes(const CharacterOptions& options, const BodyShape& shape,
                character::Character* character) {
  Clothes clothes = MakeClothes(shape);
  character::Material cloth = MakeMaterial("cloth", character::Material::Kind::kCloth, 0.85f);
  const int size = options.texture_size;
  cloth.base_colour_texture =
      AddPicture(character, PaintClothColour(clothes, options.body, 2 * size));
  cloth.normal_texture = AddPicture(character, PaintClothNormals(clothes, 2 * size));
  cloth.roughness_texture = AddPicture(character, PaintClothRoughness(clothes, size));
  for (character::Picture& mask : PaintClothMasks(clothes, size / 2)) {
    const std::string name = mask.name;
    AddRigPicture(character, name.c_str(), std::move(mask));
  }
  AddMesh(character, std::move(clothes.mesh), std::move(cloth));

  character::Material leather = MakeMaterial("leather", character::Material::Kind::kOther, 0.45f);
  leather.base_colour = glm::vec4(0.035f, 0.022f, 0.015f, 1.0f);
  AddMesh(character, MakeLeather(shape), std::move(leather));
}

Status CopyRigs(const std::filesystem::path& rigs, const std::filesystem::path& share) {
  constexpr std::size_t kMaxRig = 16u << 20;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(rigs)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const std::filesystem::path& file : files) {
    Result<std::string> text = ReadFile(file, kMaxRig);
    FURROW_RETURN_IF_ERROR(text);
    const auto write = [&](const std::filesystem::path& to) {
      return WriteFileAtomically(to, text.value());
    };
    FURROW_RETURN_IF_ERROR(write(share / "rigs" / file.filename()));
  }
  return Status();
}

Status WriteRecordings(const wrinkle::Rig& rig, const wrinkle::Skeleton& skeleton,
                       const std::filesystem::path& folder) {
  for (const std::string& name : RecordingNames()) {
    Result<Recording> recording = MakeRecording(name, rig, skeleton);
    FURROW_RETURN_IF_ERROR(recording);
    const std::string text = RecordingToBvh(recording.value(), skeleton);
    FURROW_RETURN_IF_ERROR(WriteFileAtomically(folder / (name + ".bvh"), text));
  }
  return Status();
}

}  // namespace

character::Character MakeDefaultCharacter(const wrinkle::Rig& rig,
                                          const CharacterOptions& options) {
  character::Character character;
  character.name = "default";
  character.skeleton = MakeSkeleton();
  character.rig = rig;
  for (const glm::mat4& model : character.skeleton.rest_model()) {
    // Joints are not rotated at rest, so the inverse is a translation.
    character.inverse_bind_matrices.push_back(
        glm::translate(glm::mat4(1.0f), -glm::vec3(model[3])));
  }
  const HeadShape shape(options.face);
  const BodyShape body(options.body, character.skeleton, shape);
  AddSkin(options, shape, body, &character);
  AddHeadParts(options, shape, &character);
  AddClothes(options, body, &character);
  return character;
}

Status WriteCharacter(const std::filesystem::path& rigs, const CharacterOptions& options,
                      const std::filesystem::path& glb) {
  Result<wrinkle::Rig> rig = rig::LoadRig(rigs / "default.json");
  FURROW_RETURN_IF_ERROR(rig);
  Result<std::vector<BakeStroke>> strokes = LoadStrokes(rigs / "default.strokes.json", rig.value());
  FURROW_RETURN_IF_ERROR(strokes);
  character::Character character = MakeDefaultCharacter(rig.value(), options);
  character.name = glb.stem().string();
  if (Status status = AddWrinkleMaps(strokes.value(), options.texture_size,
                                     WrinkleDepth(options.face), &character);
      !status.ok()) {
    return status;
  }
  const bool shapes = options.face_kind == FaceKind::kBlendShapes;
  if (shapes) FURROW_RETURN_IF_ERROR(MakeBlendShapeFace(&character));
  FURROW_RETURN_IF_ERROR(character::SaveCharacterGlb(character, glb));
  const std::filesystem::path beside = character::RigBeside(glb);
  if (shapes) return rig::SaveRig(character.rig, beside);
  // Copied, because the file has comments.
  constexpr std::size_t kMaxRig = 16u << 20;
  Result<std::string> text = ReadFile(rigs / "default.json", kMaxRig);
  FURROW_RETURN_IF_ERROR(text);
  return WriteFileAtomically(beside, text.value());
}

Status WriteShare(const std::filesystem::path& rigs, const std::filesystem::path& share) {
  std::error_code error;
  std::filesystem::create_directories(share / "rigs", error);
  std::filesystem::create_directories(share / "recordings", error);
  if (error) return Status(StatusCode::kIo, "cannot create the folder: " + error.message(), share);
  FURROW_RETURN_IF_ERROR(WriteCharacter(rigs, {}, share / "default.glb"));
  FURROW_RETURN_IF_ERROR(CopyRigs(rigs, share));
  Result<wrinkle::Rig> rig = rig::LoadRig(rigs / "default.json");
  FURROW_RETURN_IF_ERROR(rig);
  return WriteRecordings(rig.value(), MakeSkeleton(), share / "recordings");
}

Status WriteElder(const std::filesystem::path& rigs, const std::filesystem::path& glb) {
  CharacterOptions elder;
  elder.face = {.sex = -1.0f, .age = 65.0f};
  elder.body = {.shoulder_width = 0.92f,
                .chest = 0.97f,
                .waist = 1.02f,
                .hips = 1.04f,
                .limbs = 0.94f,
                .bust = 0.035f,
                .shirt = {0.55f, 0.42f, 0.44f}};
  elder.texture_size = 512;
  return WriteCharacter(rigs, elder, glb);
}

}  // namespace furrow::authoring
