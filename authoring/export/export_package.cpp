// SPDX-License-Identifier: Apache-2.0
#include "authoring/export/export_package.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "authoring/export/export_pictures.h"
#include "authoring/export/export_plan.h"
#include "authoring/export/shader_files.h"
#include "authoring/export/wrinkles_json.h"
#include "base/joined.h"
#include "base/text.h"
#include "character/pictures/picture_file.h"
#include "render/wrinkles/derivative_map.h"

namespace furrow::authoring {
namespace {

using character::Picture;

// Writes the files of one export.
class Exporter {
 public:
  Exporter(const character::Character& character, const ExportOptions& options,
           const FileSink& write)
      : character_(character), options_(options), write_(write) {
    const EngineTraits& traits = TraitsOf(options.engine);
    normals_ = {options.bits.value_or(traits.bits), traits.green_down};
    derivatives_ = {options.bits.value_or(16), traits.green_down};
  }

  Result<ExportedFiles> Run() {
    auto plan = PlanExport(character_);
    FURROW_RETURN_IF_ERROR(plan);
    plan_ = std::move(*plan);
    FURROW_RETURN_IF_ERROR(CheckParameters());
    FURROW_RETURN_IF_ERROR(WriteMaps());
    FURROW_RETURN_IF_ERROR(WriteMasks());
    for (const ExportPlan::Material& material : plan_.materials) {
      FURROW_RETURN_IF_ERROR(WriteMaterial(material));
    }
    FURROW_RETURN_IF_ERROR(WriteTexts());
    done_.notes = plan_.notes;
    return std::move(done_);
  }

 private:
  // Engines that find a parameter by name would move two weights at once.
  Status CheckParameters() const {
    std::map<std::string, std::string> seen;
    for (const ExportPlan::Weight& weight : plan_.weights) {
      const auto [other, is_new] = seen.emplace(PropertyName(weight.name), weight.name);
      if (is_new) continue;
      return {StatusCode::kInvalidArgument,
              "the wrinkle weights '" + other->second + "' and '" + weight.name +
                  "' would share the parameter '" + other->first + "'",
              "", "rename a region or a map in the rig"};
    }
    return {};
  }

  Status Write(const std::string& name, std::string_view bytes) {
    FURROW_RETURN_IF_ERROR(write_(name, bytes));
    done_.names.push_back(name);
    return {};
  }

  Status WritePicture(const std::string& key, const std::string& stem, const Picture& picture) {
    const auto png = character::EncodePng(picture);
    FURROW_RETURN_IF_ERROR(png);
    const std::string name = "textures/" + stem + ".png";
    files_[key] = name;
    return Write(name, *png);
  }

  [[nodiscard]] const Picture& PictureAt(int index) const {
    return character_.pictures[static_cast<std::size_t>(index)];
  }

  // Copies a picture of the character, if it has one.
  Status WriteCopy(const std::string& key, const std::string& stem, int index) {
    if (index < 0) return {};
    return WritePicture(key, stem, IntegerPicture(PictureAt(index)));
  }

  // The normal map of a relief, and its derivative map if the options ask for it.
  Status WriteRelief(const std::string& kind, const std::string& name, const std::string& stem,
                     const render::DerivativeMap& slopes) {
    FURROW_RETURN_IF_ERROR(WritePicture(PictureKey(kind, name, "normal"), stem + "_normal",
                                        NormalMapPicture(slopes, normals_)));
    if (!options_.derivatives) return {};
    const DerivativePicture map = DerivativeMapPicture(slopes, derivatives_);
    const std::string key = PictureKey(kind, name, "derivative");
    derivative_scales_[key] = map.scale;
    return WritePicture(key, stem + "_derivative", map.picture);
  }

  Status WriteMaps() {
    for (std::size_t i = 0; i < plan_.maps.size(); ++i) {
      const ExportPlan::Map& map = plan_.maps[i];
      const wrinkle::WrinkleMap& of =
          character_.rig.wrinkle_maps[static_cast<std::size_t>(map.map)];
      const auto key = [&](const char* part) { return PictureKey("map", map.name, part); };
      if (map.has_relief()) {
        FURROW_RETURN_IF_ERROR(WriteRelief("map", map.name, map.name, SlopesOf(character_, map)));
      }
      if (map.height >= 0) {
        const HeightMap height = HeightMapOf(PictureAt(map.height), of.height_mm);
        height_mm_[static_cast<int>(i)] = height.millimetres;
        FURROW_RETURN_IF_ERROR(WritePicture(key("height"), map.name + "_height", height.picture));
      }
      FURROW_RETURN_IF_ERROR(WriteCopy(key("colour"), map.name + "_colour", map.colour));
      FURROW_RETURN_IF_ERROR(WriteCopy(key("cavity"), map.name + "_cavity", map.cavity));
    }
    return {};
  }

  Status WriteMasks() {
    std::vector<std::string> shared;
    for (std::size_t i = 0; i < plan_.masks.size(); ++i) {
      const std::string number = std::to_string(i);
      FURROW_RETURN_IF_ERROR(WritePicture(PictureKey("mask", number), "masks_" + number,
                                          MaskPicture(character_, plan_.masks[i], &shared)));
    }
    if (shared.empty()) return {};
    plan_.notes.push_back(Counted(shared.size(), "region") +
                          " on parts that share a texture, so that these parts fold together: " +
                          CutText(Joined(shared), 200));
    return {};
  }

  Status WriteMaterial(const ExportPlan::Material& entry) {
    const character::Material& material =
        character_.materials[static_cast<std::size_t>(entry.material)];
    const auto key = [&](const char* part) { return PictureKey("material", entry.name, part); };
    const std::string stem = "material_" + entry.name;
    FURROW_RETURN_IF_ERROR(
        WriteCopy(key("colour"), stem + "_colour", material.base_colour_texture));
    FURROW_RETURN_IF_ERROR(
        WriteCopy(key("roughness"), stem + "_roughness", material.roughness_texture));
    if (material.normal_texture < 0) return {};
    return WriteRelief("material", entry.name, stem,
                       render::DerivativesFromNormalMap(PictureAt(material.normal_texture)));
  }

  // After the pictures, whose files the texts name.
  Status WriteTexts() {
    TemplateData data = ShaderData(character_, plan_, options_.engine, files_);
    if (options_.derivatives) {
      data.texts["derivatives"] = normals_.green_down ? "down" : "up";
    }
    const auto shaders = ShaderFiles(options_.engine, data);
    FURROW_RETURN_IF_ERROR(shaders);
    for (const TextFile& shader : *shaders) {
      if (shader.material >= 0) {
        // The first one, if an engine has two dialects.
        files_.emplace("shader." + plan_.materials[static_cast<std::size_t>(shader.material)].name,
                       shader.name);
      }
      FURROW_RETURN_IF_ERROR(Write(shader.name, shader.text));
    }
    const std::vector<rig::ExportCoverage> names = Coverages();
    const WrinklesFile file{.engine = options_.engine,
                            .normals = normals_,
                            .generator = options_.generator,
                            .names = names,
                            .files = &files_,
                            .height_mm = &height_mm_,
                            .derivative_scales = &derivative_scales_,
                            .derivative_bits = options_.derivatives ? derivatives_.bits : 0};
    FURROW_RETURN_IF_ERROR(Write("wrinkles.json", WrinklesJson(character_, plan_, file)));
    const auto readme = ReadmeFile(options_.engine, data);
    FURROW_RETURN_IF_ERROR(readme);
    return Write(readme->name, readme->text);
  }

  // The given profiles, and those that only the rig has.
  [[nodiscard]] std::vector<rig::ExportCoverage> Coverages() const {
    std::vector<rig::ExportCoverage> names;
    std::set<std::string> listed;
    for (const rig::ExportProfile& profile : options_.profiles) {
      listed.insert(profile.name);
      names.push_back(rig::CoverExports(character_.rig, profile));
    }
    for (const wrinkle::Export& entry : character_.rig.exports) {
      if (!listed.insert(entry.profile).second) continue;
      names.push_back(rig::CoverExports(character_.rig, {entry.profile, "", {}}));
    }
    return names;
  }

  const character::Character& character_;
  const ExportOptions& options_;
  const FileSink& write_;
  NormalFormat normals_;
  NormalFormat derivatives_;
  ExportPlan plan_;
  ExportedFiles done_;
  std::map<std::string, std::string> files_;
  std::map<int, float> height_mm_;
  std::map<std::string, float> derivative_scales_;
};

}  // namespace

Result<ExportedFiles> ExportCharacter(const character::Character& character,
                                      const ExportOptions& options, const FileSink& write) {
  return Exporter(character, options, write).Run();
}

}  // namespace furrow::authoring
