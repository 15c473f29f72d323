// SPDX-License-Identifier: Apache-2.0
#include "authoring/export/wrinkles_json.h"

#include <array>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/numbers.h"
#include "render/request/camera_preset.h"

namespace furrow::authoring {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 4> kChannels = {"r", "g", "b", "a"};

// The double whose shortest text is that of the float: 0.3 instead of 0.30000001192092896.
Json Number(float value) {
  std::string text;
  AppendShortest(value, &text);
  double number = 0.0;
  return TryParseNumber(text, &number) ? Json(number) : Json(value);
}

template <class Vector>
Json Numbers(const Vector& v) {
  Json list = Json::array();
  for (int i = 0; i < Vector::length(); ++i) list.push_back(Number(v[i]));
  return list;
}

Json Curve(const std::vector<wrinkle::CurvePoint>& points) {
  Json list = Json::array();
  for (const wrinkle::CurvePoint& point : points)
    list.push_back(Json::array({Number(point.x), Number(point.y)}));
  return list;
}

class Writer {
 public:
  Writer(const character::Character& character, const ExportPlan& plan, const WrinklesFile& file)
      : character_(character), plan_(plan), file_(file) {}

  Json Run() const {
    const char* green = file_.normals.green_down ? "down" : "up";
    Json json = {{"format", "furrow-wrinkles"},
                 {"version", kWrinklesVersion},
                 {"generator", file_.generator},
                 {"character", character_.name},
                 {"engine", TraitsOf(file_.engine).name},
                 {"normals", {{"green", green}, {"bits", file_.normals.bits}}}};
    if (file_.derivative_bits > 0) {
      json["derivatives"] = {{"green", green}, {"bits", file_.derivative_bits}};
    }
    json["maps"] = Maps();
    json["masks"] = Masks();
    json["weights"] = Weights();
    json["materials"] = Materials();
    json["cameras"] = Cameras();
    json["notes"] = plan_.notes;
    return json;
  }

 private:
  [[nodiscard]] const wrinkle::Rig& rig() const { return character_.rig; }
  // The file, or null if the export has none.
  [[nodiscard]] Json File(const std::string& key) const {
    const auto found = file_.files->find(key);
    return found == file_.files->end() ? Json(nullptr) : Json(found->second);
  }

  // Adds the derivative map of `key` and its scale, if there is one: "derivative" and
  // "derivative_scale" after `prefix`.
  void AddDerivative(const std::string& key, const std::string& prefix, Json* json) const {
    const auto scale = file_.derivative_scales->find(key);
    if (scale == file_.derivative_scales->end()) return;
    (*json)[prefix + "derivative"] = File(key);
    (*json)[prefix + "derivative_scale"] = Number(scale->second);
  }

  [[nodiscard]] Json Maps() const {
    Json list = Json::array();
    for (std::size_t i = 0; i < plan_.maps.size(); ++i) {
      const ExportPlan::Map& entry = plan_.maps[i];
      const wrinkle::WrinkleMap& map = rig().wrinkle_maps[static_cast<std::size_t>(entry.map)];
      constexpr std::array kSurfaces = {"any", "skin", "cloth"};  // WrinkleMap::Surface
      Json json = {{"name", map.name},
                   {"surface", kSurfaces.at(static_cast<std::size_t>(map.surface))},
                   {"normal", File(PictureKey("map", entry.name, "normal"))},
                   {"strength", Number(map.amplitude)},
                   {"height", File(PictureKey("map", entry.name, "height"))}};
      if (const auto mm = file_.height_mm->find(static_cast<int>(i));
          mm != file_.height_mm->end()) {
        json["height_mm"] = Number(mm->second);
      }
      AddDerivative(PictureKey("map", entry.name, "derivative"), "", &json);
      json["colour"] = File(PictureKey("map", entry.name, "colour"));
      if (entry.colour >= 0) json["colour_scale"] = Number(map.colour_scale);
      json["cavity"] = File(PictureKey("map", entry.name, "cavity"));
      if (!map.opposes.empty()) json["opposes"] = map.opposes;
      list.push_back(std::move(json));
    }
    return list;
  }

  [[nodiscard]] Json Masks() const {
    Json list = Json::array();
    for (std::size_t i = 0; i < plan_.masks.size(); ++i) {
      Json channels = Json::array();
      for (int channel = 0; channel < 4; ++channel) {
        const std::string regions = RegionsOf(rig(), plan_, static_cast<int>(i), channel);
        channels.push_back(regions.empty() ? Json(nullptr) : Json(regions));
      }
      list.push_back({{"file", File(PictureKey("mask", std::to_string(i)))},
                      {"channels", std::move(channels)}});
    }
    return list;
  }

  [[nodiscard]] Json Weights() const {
    Json list = Json::array();
    for (std::size_t i = 0; i < plan_.weights.size(); ++i) {
      list.push_back(WeightJson(i, plan_.weights[i]));
    }
    return list;
  }

  [[nodiscard]] Json WeightJson(std::size_t index, const ExportPlan::Weight& weight) const {
    const wrinkle::Region& region = rig().regions[static_cast<std::size_t>(weight.region)];
    const wrinkle::Feed& feed = region.feeds[static_cast<std::size_t>(weight.feed)];
    Json json = {{"name", weight.name}, {"index", index}, {"region", region.name}};
    if (weight.is_drawn()) {
      const int map = plan_.maps[static_cast<std::size_t>(weight.map)].map;
      json["map"] = weight.map;
      json["mask"] = weight.mask;
      json["channel"] = kChannels.at(static_cast<std::size_t>(weight.channel));
      json["skinned"] = weight.is_skinned;
      json["strength"] = Number(rig().wrinkle_maps[static_cast<std::size_t>(map)].amplitude);
    } else {
      json["map"] = nullptr;
      json["mask"] = nullptr;
    }
    json["parameter"] = ParameterName(file_.engine, weight.name);
    json["property"] = PropertyName(weight.name);
    json["names"] = Names(weight.name);
    json["drivers"] = Drivers(region, feed);
    return json;
  }

  // {"metahuman": ["head_wm2_...", ...]}
  [[nodiscard]] Json Names(const std::string& weight) const {
    Json names = Json::object();
    for (const rig::ExportCoverage& coverage : file_.names) {
      Json list = Json::array();
      for (const rig::ExportProfile::Name& name : coverage.names) {
        for (const std::string& of : name.weights) {
          if (of == weight) list.push_back(name.name);
        }
      }
      if (!list.empty()) names[coverage.profile] = std::move(list);
    }
    return names;
  }

  // Hints: what raises the weight. A daemon sends the finished weight.
  [[nodiscard]] Json Drivers(const wrinkle::Region& region, const wrinkle::Feed& feed) const {
    constexpr std::array kCombine = {"max", "sum", "mean", "sum_modulated"};  // wrinkle::Combine
    constexpr std::array kModulation = {"linear", "cosine", "cubic"};         // wrinkle::Modulation
    Json sources = Json::array();
    for (const wrinkle::Feed::Source& source : feed.sources) {
      Json json = {{"driver", source.driver}};
      for (const wrinkle::Driver& driver : rig().drivers) {
        if (driver.name == source.driver) json["kind"] = wrinkle::DriverKindName(driver.kind);
      }
      json["value"] = source.value;
      json["gain"] = Number(source.gain);
      sources.push_back(std::move(json));
    }
    Json json = {{"combine", kCombine.at(static_cast<std::size_t>(region.combine))},
                 {"sources", std::move(sources)}};
    if (!feed.angles.empty()) {
      json["angles"] = Curve(feed.angles);
    } else if (!feed.curve.empty()) {
      json["curve"] = Curve(feed.curve);
    } else if (!feed.modulation && !region.curve.empty()) {
      json["curve"] = Curve(region.curve);
    } else {
      const auto modulation = feed.modulation.value_or(region.modulation);
      json["modulation"] = kModulation.at(static_cast<std::size_t>(modulation));
    }
    return json;
  }

  [[nodiscard]] Json Materials() const {
    Json list = Json::array();
    for (const ExportPlan::Material& entry : plan_.materials) {
      const character::Material& material =
          character_.materials[static_cast<std::size_t>(entry.material)];
      Json json = {{"name", material.name},
                   {"surface", entry.cloth ? "cloth" : "skin"},
                   {"base_colour", File(PictureKey("material", entry.name, "colour"))},
                   {"base_colour_factor", Numbers(material.base_colour)},
                   {"base_normal", File(PictureKey("material", entry.name, "normal"))},
                   {"roughness", File(PictureKey("material", entry.name, "roughness"))},
                   {"roughness_factor", Number(material.roughness)},
                   {"texture_scale", Numbers(material.texture_scale)},
                   {"texture_offset", Numbers(material.texture_offset)},
                   {"maps", entry.maps},
                   {"masks", entry.masks},
                   {"weights", entry.weights},
                   {"shader", File("shader." + entry.name)}};
      AddDerivative(PictureKey("material", entry.name, "derivative"), "base_", &json);
      list.push_back(std::move(json));
    }
    return list;
  }

  [[nodiscard]] Json Cameras() const {
    Json list = Json::array();
    for (const auto& [name, camera] : render::CameraPresets(character_)) {
      list.push_back({{"name", name},
                      {"position", Numbers(camera.position)},
                      {"target", Numbers(camera.target)},
                      {"fov_y_degrees", Number(camera.fov_y_degrees)}});
    }
    return list;
  }

  const character::Character& character_;
  const ExportPlan& plan_;
  const WrinklesFile& file_;
};

}  // namespace

std::string PictureKey(const std::string& kind, const std::string& name, const std::string& part) {
  return part.empty() ? kind + "." + name : kind + "." + name + "." + part;
}

std::string WrinklesJson(const character::Character& character, const ExportPlan& plan,
                         const WrinklesFile& file) {
  // Names come from files. Invalid UTF-8 must not throw.
  return Writer(character, plan, file).Run().dump(2, ' ', false, Json::error_handler_t::replace) +
         "\n";
}

}  // namespace furrow::authoring
