// SPDX-License-Identifier: Apache-2.0
#include "authoring/export/shader_files.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include "authoring/export/engine_files.h"
#include "authoring/export/wrinkles_json.h"
#include "base/numbers.h"
#include "base/text.h"

namespace furrow::authoring {
namespace {

// A file of an engine's exports. '*' in `target` stands for the material's name; the source is then
// a template that is expanded once per material.
struct FileRule {
  Engine engine;
  std::string_view source;
  std::string_view target;
};

constexpr std::string_view kGlsl = "client/engines/glsl/furrow_wrinkles.glsl";
constexpr std::string_view kGlslMaterial = "client/engines/glsl/furrow_material.glsl.in";
constexpr std::array<FileRule, 12> kRules = {{
    {Engine::kGeneric, kGlsl, "shaders/furrow_wrinkles.glsl"},
    {Engine::kGeneric, kGlslMaterial, "shaders/furrow_*.glsl"},
    {Engine::kThree, kGlsl, "shaders/furrow_wrinkles.glsl"},
    {Engine::kThree, kGlslMaterial, "shaders/furrow_*.glsl"},
    {Engine::kUnity, "client/engines/unity/Runtime/Shaders/FurrowWrinkles.hlsl",
     "shaders/FurrowWrinkles.hlsl"},
    {Engine::kUnity, "client/engines/unity/Runtime/Shaders/FurrowMaterial.hlsl.in",
     "shaders/Furrow_*.hlsl"},
    {Engine::kUnreal, "client/engines/unreal/Shaders/FurrowWrinkles.ush",
     "shaders/FurrowWrinkles.ush"},
    {Engine::kUnreal, "client/engines/unreal/Shaders/FurrowMaterial.ush.in",
     "shaders/Furrow_*.ush"},
    {Engine::kGodot, "client/engines/godot/addons/furrow/shaders/furrow_wrinkles.shader.in",
     "shaders/furrow_*.shader"},
    {Engine::kGodot, "client/engines/godot/addons/furrow/shaders/furrow_wrinkles.gdshader.in",
     "shaders/furrow_*.gdshader"},
    {Engine::kGodot, "client/engines/godot/addons/furrow/furrow_material.gd", "furrow_material.gd"},
    {Engine::kBlender, "client/engines/blender/furrow/nodes.py", "nodes.py"},
}};

Result<std::string_view> TextOf(std::string_view path) {
  const auto files = EngineFiles();
  const auto found = std::ranges::find(files, path, &EngineFile::path);
  if (found != files.end()) return found->text;
  return Status(StatusCode::kInternal, "the build lacks the file", std::string(path));
}

// Templates are part of the program, so their faults are bugs.
Result<std::string> Expand(std::string_view path, const TemplateData& data) {
  const auto text = TextOf(path);
  FURROW_RETURN_IF_ERROR(text);
  auto expanded = ExpandTemplate(*text, data, path);
  if (expanded.ok()) return expanded;
  return Status(StatusCode::kInternal, expanded.status().what(), expanded.status().where());
}

// A literal of all shading languages: digits with a point.
std::string Literal(float value) {
  std::string text;
  AppendShortest(value, &text);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

// Collects the data of one material.
class MaterialData {
 public:
  MaterialData(const character::Character& character, const ExportPlan& plan, Engine engine,
               const std::map<std::string, std::string>& files)
      : character_(character), plan_(plan), engine_(engine), files_(files) {}

  [[nodiscard]] TemplateData Run(const ExportPlan::Material& entry) const {
    const character::Material& material =
        character_.materials[static_cast<std::size_t>(entry.material)];
    const bool is_cut = material.alpha_cutoff > 0.0f;
    TemplateData data;
    data.texts = {{"material", entry.name},
                  {"original", material.name},
                  {"double_sided", material.double_sided ? "yes" : ""},
                  {"alpha_cutoff", is_cut ? Literal(material.alpha_cutoff) : ""},
                  {"base_colour", File("material", entry.name, "colour")},
                  {"base_normal", File("material", entry.name, "normal")},
                  {"roughness", File("material", entry.name, "roughness")},
                  {"base_uv", BaseUv(entry)},
                  {"first_mask", std::to_string(entry.masks.front())}};
    // What a README calls it must not break its table.
    std::ranges::replace_if(
        data.texts["original"], [](char c) { return c == '|' || c == '`' || c < ' '; }, '_');
    for (const int map : entry.maps) data.lists["maps"].push_back(Map(map, entry));
    for (const int mask : entry.masks) data.lists["masks"].push_back(Mask(mask));
    for (const int weight : entry.weights) data.lists["weights"].push_back(Weight(weight));
    data.lists["packs"] = Packs(entry);
    data.texts["textures"] = Counted(NumTextures(data), "texture");
    return data;
  }

  [[nodiscard]] TemplateData Weight(int index) const {
    const ExportPlan::Weight& weight = plan_.weights[static_cast<std::size_t>(index)];
    TemplateData data;
    data.texts = {{"index", std::to_string(index)},
                  {"name", weight.name},
                  {"parameter", ParameterName(engine_, weight.name)},
                  {"property", PropertyName(weight.name)}};
    return data;
  }

 private:
  // Pictures that the shader of a material reads. Engines limit their number.
  [[nodiscard]] static std::size_t NumTextures(const TemplateData& material) {
    std::size_t count = material.lists.at("masks").size();
    if (!material.texts.at("base_normal").empty()) ++count;
    for (const TemplateData& map : material.lists.at("maps")) {
      for (const char* part : {"normal", "colour", "cavity"}) {
        if (!map.texts.at(part).empty()) ++count;
      }
    }
    return count;
  }

  [[nodiscard]] std::string File(const std::string& kind, const std::string& name,
                                 const std::string& part = {}) const {
    const auto found = files_.find(PictureKey(kind, name, part));
    return found == files_.end() ? std::string() : found->second;
  }

  // The UVs of the material's own textures.
  [[nodiscard]] std::string BaseUv(const ExportPlan::Material& entry) const {
    const character::Material& material =
        character_.materials[static_cast<std::size_t>(entry.material)];
    const std::string uv = engine_ == Engine::kGodot ? "UV" : "uv";
    if (material.texture_scale == glm::vec2(1.0f) && material.texture_offset == glm::vec2(0.0f)) {
      return uv;
    }
    const std::string vec2 =
        engine_ == Engine::kUnity || engine_ == Engine::kUnreal ? "float2" : "vec2";
    const auto pair = [&](const glm::vec2& v) {
      return vec2 + "(" + Literal(v.x) + ", " + Literal(v.y) + ")";
    };
    glm::vec2 offset = material.texture_offset;
    // Unity counts v from the bottom of the picture, glTF from the top.
    if (engine_ == Engine::kUnity) offset.y = 1.0f - material.texture_scale.y - offset.y;
    return "(" + uv + " * " + pair(material.texture_scale) + " + " + pair(offset) + ")";
  }

  // The expression of a weight in the engine's language.
  [[nodiscard]] std::string Accessor(int weight, const ExportPlan::Material& entry) const {
    const std::string& name = plan_.weights[static_cast<std::size_t>(weight)].name;
    const std::string index = "[" + std::to_string(weight) + "]";
    switch (engine_) {
      case Engine::kUnity: return "_FurrowWeights" + index;
      case Engine::kUnreal: {
        const auto place = std::ranges::find(entry.weights, weight) - entry.weights.begin();
        return "Weights" + std::to_string(place / 4) + "." +
               "xyzw"[static_cast<std::size_t>(place % 4)];
      }
      case Engine::kGodot: return PropertyName(name);
      default: return "furrowWeights" + index;
    }
  }

  // The weights that raise a map, one vector per mask.
  [[nodiscard]] std::vector<TemplateData> Terms(int map, const ExportPlan::Material& entry,
                                                bool skinned) const {
    std::vector<TemplateData> terms;
    for (const int mask : entry.masks) {
      std::array<std::string, 4> channels;
      for (const int w : entry.weights) {
        const ExportPlan::Weight& weight = plan_.weights[static_cast<std::size_t>(w)];
        if (weight.map != map || weight.mask != mask || weight.is_skinned != skinned) continue;
        std::string& channel = channels[static_cast<std::size_t>(weight.channel)];
        const std::string value = Accessor(w, entry);
        channel = channel.empty() ? value : "max(" + channel + ", " + value + ")";
      }
      if (std::ranges::all_of(channels, &std::string::empty)) continue;
      for (std::string& channel : channels) {
        if (channel.empty()) channel = "0.0";
      }
      TemplateData& term = terms.emplace_back();
      term.texts = {{"mask", std::to_string(mask)},
                    {"r", channels[0]},
                    {"g", channels[1]},
                    {"b", channels[2]},
                    {"a", channels[3]}};
    }
    return terms;
  }

  [[nodiscard]] TemplateData Map(int index, const ExportPlan::Material& entry) const {
    const ExportPlan::Map& map = plan_.maps[static_cast<std::size_t>(index)];
    const wrinkle::WrinkleMap& of = character_.rig.wrinkle_maps[static_cast<std::size_t>(map.map)];
    TemplateData data;
    data.texts = {{"index", std::to_string(index)},
                  {"name", of.name},
                  {"normal", File("map", map.name, "normal")},
                  {"height", File("map", map.name, "height")},
                  {"colour", File("map", map.name, "colour")},
                  {"cavity", File("map", map.name, "cavity")},
                  {"strength", Literal(of.amplitude)},
                  {"colour_scale", Literal(of.colour_scale)}};
    data.texts["looks"] = data.texts["colour"] + data.texts["cavity"];
    data.lists["terms"] = Terms(index, entry, false);
    data.lists["skinned"] = Terms(index, entry, true);
    return data;
  }

  [[nodiscard]] TemplateData Mask(int index) const {
    TemplateData data;
    std::string channels;
    for (int channel = 0; channel < 4; ++channel) {
      const std::string regions = RegionsOf(character_.rig, plan_, index, channel);
      if (regions.empty()) continue;
      channels += (channels.empty() ? "" : ", ") + std::string(1, "rgba"[channel]) + " " + regions;
    }
    data.texts = {{"index", std::to_string(index)},
                  {"file", File("mask", std::to_string(index))},
                  {"channels", channels}};
    return data;
  }

  // Four weights each, for inputs of four components.
  [[nodiscard]] std::vector<TemplateData> Packs(const ExportPlan::Material& entry) const {
    std::vector<TemplateData> packs;
    for (std::size_t first = 0; first < entry.weights.size(); first += 4) {
      TemplateData& pack = packs.emplace_back();
      pack.texts["index"] = std::to_string(first / 4);
      std::string names;
      for (std::size_t i = first; i < std::min(first + 4, entry.weights.size()); ++i) {
        const auto weight = static_cast<std::size_t>(entry.weights[i]);
        names += (names.empty() ? "" : ", ") + plan_.weights[weight].name;
      }
      pack.texts["names"] = names;
    }
    return packs;
  }

  const character::Character& character_;
  const ExportPlan& plan_;
  Engine engine_;
  const std::map<std::string, std::string>& files_;
};

}  // namespace

TemplateData ShaderData(const character::Character& character, const ExportPlan& plan,
                        Engine engine, const std::map<std::string, std::string>& files) {
  const MaterialData data(character, plan, engine, files);
  TemplateData all;
  all.texts = {{"weight_count", std::to_string(plan.weights.size())},
               {"engine", std::string(TraitsOf(engine).title)},
               {"derivatives", ""}};
  for (const ExportPlan::Material& material : plan.materials) {
    all.lists["materials"].push_back(data.Run(material));
  }
  for (std::size_t i = 0; i < plan.weights.size(); ++i) {
    all.lists["all_weights"].push_back(data.Weight(static_cast<int>(i)));
  }
  std::vector<TemplateData>& notes = all.lists["notes"];
  for (const std::string& note : plan.notes) notes.push_back({{{"note", note}}, {}});
  return all;
}

Result<std::vector<TextFile>> ShaderFiles(Engine engine, const TemplateData& data) {
  std::vector<TextFile> files;
  const std::vector<TemplateData>& materials = data.lists.at("materials");
  for (const FileRule& rule : kRules) {
    if (rule.engine != engine) continue;
    const std::string target(rule.target);
    const std::size_t star = target.find('*');
    if (star == std::string::npos) {
      const auto text = TextOf(rule.source);
      FURROW_RETURN_IF_ERROR(text);
      files.push_back({target, std::string(*text), -1});
      continue;
    }
    for (std::size_t i = 0; i < materials.size(); ++i) {
      TemplateData scope = materials[i];
      scope.texts.insert(data.texts.begin(), data.texts.end());
      auto text = Expand(rule.source, scope);
      FURROW_RETURN_IF_ERROR(text);
      std::string name = target;
      name.replace(star, 1, materials[i].texts.at("material"));
      files.push_back({std::move(name), std::move(*text), static_cast<int>(i)});
    }
  }
  return files;
}

Result<TextFile> ReadmeFile(Engine engine, const TemplateData& data) {
  const std::string path =
      "authoring/export/readme/" + std::string(TraitsOf(engine).name) + ".md.in";
  auto text = Expand(path, data);
  FURROW_RETURN_IF_ERROR(text);
  return TextFile{"README.md", std::move(*text), -1};
}

}  // namespace furrow::authoring
