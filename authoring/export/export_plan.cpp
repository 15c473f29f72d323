// SPDX-License-Identifier: Apache-2.0
#include "authoring/export/export_plan.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "authoring/export/engine.h"
#include "authoring/export/painted_mask.h"
#include "base/joined.h"
#include "base/text.h"
#include "render/wrinkles/wrinkle_table.h"

namespace furrow::authoring {
namespace {

using render::WrinkleGroup;
using wrinkle::Mask;

constexpr std::size_t kMaxStem = 100;  // bytes; file systems accept 255 for a whole name

// ASCII only, as Identifier() returns.
std::string LowerCase(std::string name) {
  for (char& c : name) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return name;
}

// Collects a plan step by step; each step refers to those before.
class Planner {
 public:
  explicit Planner(const character::Character& character) : character_(character) {}

  Result<ExportPlan> Run() {
    if (character_.rig.regions.empty()) {
      return Status(StatusCode::kNotFound, "the character has no wrinkle rig", "",
                    "give one with --rig, or write one beside the character");
    }
    AddMaps();
    AddMasks();
    AddWeights();
    AddMaterials();
    if (plan_.materials.empty()) {
      std::string why = "no wrinkle weight can be drawn";
      for (const std::string& note : plan_.notes) why += "; " + note;
      return Status(StatusCode::kUnsupported, std::move(why), "",
                    "bake maps and masks with 'furrow bake --masks', and export with the new rig");
    }
    return std::move(plan_);
  }

 private:
  [[nodiscard]] const wrinkle::Rig& rig() const { return character_.rig; }
  // A picture that the rig names; a name without a picture is in missing_rig_pictures.
  [[nodiscard]] int Find(const std::string& name) const {
    return name.empty() ? -1 : character_.FindRigPicture(name);
  }

  // An unused name for files and functions. `taken` holds names in lower case, because file systems
  // of Windows and macOS do not distinguish case.
  static std::string Free(const std::string& name, std::set<std::string>* taken) {
    const std::string base = Identifier(name).substr(0, kMaxStem);
    std::string free = base;
    for (int i = 2; !taken->insert(LowerCase(free)).second; ++i) {
      free = base + "_" + std::to_string(i);
    }
    return free;
  }

  void AddMaps() {
    std::set<std::string> taken;
    for (std::size_t i = 0; i < rig().wrinkle_maps.size(); ++i) {
      const wrinkle::WrinkleMap& map = rig().wrinkle_maps[i];
      // "material_" begins the files of materials.
      const bool is_reserved = LowerCase(Identifier(map.name)).starts_with("material_");
      const std::string name = (is_reserved ? "map_" : "") + map.name;
      ExportPlan::Map entry{.map = static_cast<int>(i),
                            .name = Free(name, &taken),
                            .normal = Find(map.normal),
                            .height = Find(map.height),
                            .colour = Find(map.colour),
                            .cavity = Find(map.cavity)};
      if (entry.normal < 0) entry.derivative = Find(map.derivative);
      if (!entry.has_relief() && entry.colour < 0 && entry.cavity < 0) {
        plan_.notes.push_back("map '" + map.name + "' has no picture");
        continue;
      }
      map_of_[map.name] = static_cast<int>(plan_.maps.size());
      plan_.maps.push_back(std::move(entry));
    }
  }

  [[nodiscard]] bool IsDrawnOn(const wrinkle::Region& region, WrinkleGroup group) const {
    return std::ranges::any_of(region.feeds, [&](const wrinkle::Feed& feed) {
      const auto map = map_of_.find(feed.map);
      if (map == map_of_.end()) return false;
      const int index = plan_.maps[static_cast<std::size_t>(map->second)].map;
      return render::IsDrawnOn(character_, rig().wrinkle_maps[static_cast<std::size_t>(index)],
                               group);
    });
  }

  // A region of `placed` with the same mask by skin weights; -1: none.
  [[nodiscard]] int FindTwin(std::size_t region, const std::vector<int>& placed) const {
    const wrinkle::Region& of = rig().regions[region];
    if (of.mask.kind != Mask::Kind::kSkinning) return -1;
    const auto is_twin = [&](int other) {
      const wrinkle::Region& with = rig().regions[static_cast<std::size_t>(other)];
      // Both are on skin, or neither is; the mask must be painted on the same materials.
      return IsDrawnOn(with, WrinkleGroup::kCloth) == IsDrawnOn(of, WrinkleGroup::kCloth) &&
             with.mask.kind == of.mask.kind && with.mask.lambda == of.mask.lambda &&
             with.mask.smooth_width == of.mask.smooth_width &&
             MaskJoints(character_, with) == MaskJoints(character_, of);
    };
    const auto found = std::ranges::find_if(placed, is_twin);
    return found == placed.end() ? -1 : *found;
  }

  // Places the masks of all regions: first of those on skin, then of the rest.
  void AddMasks() {
    std::vector<std::string> unpainted;
    for (const bool skin : {true, false}) {
      int channel = 4;
      std::vector<int> placed;
      for (std::size_t i = 0; i < rig().regions.size(); ++i) {
        const wrinkle::Region& region = rig().regions[i];
        if (IsDrawnOn(region, WrinkleGroup::kSkin) != skin) continue;
        if (!skin && !IsDrawnOn(region, WrinkleGroup::kCloth)) continue;
        const glm::ivec2 size = MaskSize(region);
        if (size == glm::ivec2(0)) {
          unpainted.push_back(region.name);
          continue;
        }
        if (const int twin = FindTwin(i, placed); twin >= 0) {
          place_of_[static_cast<int>(i)] = place_of_[twin];
          continue;
        }
        placed.push_back(static_cast<int>(i));
        if (channel == 4) {
          plan_.masks.emplace_back();
          channel = 0;
        }
        Place(static_cast<int>(i), size, channel++);
      }
    }
    if (unpainted.empty()) return;
    plan_.notes.push_back(
        Counted(unpainted.size(), "region") +
        " whose mask cannot become a picture: " + CutText(Joined(unpainted), 200));
  }

  // The texels of a region's mask; 0 x 0 if it cannot become a picture.
  [[nodiscard]] glm::ivec2 MaskSize(const wrinkle::Region& region) const {
    switch (region.mask.kind) {
      case Mask::Kind::kTexture: {
        const int index = Find(region.mask.texture);
        if (index < 0) return glm::ivec2(0);
        const character::Picture& picture = character_.pictures[static_cast<std::size_t>(index)];
        return {picture.width, picture.height};
      }
      case Mask::Kind::kSkinning:
      case Mask::Kind::kSliding:
        return glm::ivec2(CanPaintMask(character_, region) ? kPaintedMaskSide : 0);
    }
    return glm::ivec2(0);
  }

  void Place(int region, const glm::ivec2& size, int channel) {
    ExportPlan::Mask& mask = plan_.masks.back();
    mask.regions[static_cast<std::size_t>(channel)] = region;
    mask.width = std::max(mask.width, size.x);
    mask.height = std::max(mask.height, size.y);
    place_of_[region] = {static_cast<int>(plan_.masks.size()) - 1, channel};
  }

  void AddWeights() {
    for (std::size_t r = 0; r < rig().regions.size(); ++r) {
      const wrinkle::Region& region = rig().regions[r];
      for (std::size_t f = 0; f < region.feeds.size(); ++f) {
        ExportPlan::Weight weight{.name = region.name + "." + region.feeds[f].map,
                                  .region = static_cast<int>(r),
                                  .feed = static_cast<int>(f)};
        const auto map = map_of_.find(region.feeds[f].map);
        const auto place = place_of_.find(static_cast<int>(r));
        if (map != map_of_.end() && place != place_of_.end()) {
          weight.map = map->second;
          std::tie(weight.mask, weight.channel) = place->second;
          weight.is_skinned = region.mask.kind != Mask::Kind::kTexture;
        }
        plan_.weights.push_back(std::move(weight));
      }
    }
  }

  void AddMaterials() {
    std::set<std::string> taken = {"wrinkles"};  // of shaders/furrow_wrinkles.glsl
    for (std::size_t i = 0; i < character_.materials.size(); ++i) {
      const character::Material& material = character_.materials[i];
      const WrinkleGroup group = render::GroupOf(character_, material);
      if (group == WrinkleGroup::kNone) continue;
      ExportPlan::Material entry{.material = static_cast<int>(i),
                                 .cloth = group == WrinkleGroup::kCloth};
      std::set<int> maps, masks;
      for (std::size_t w = 0; w < plan_.weights.size(); ++w) {
        const ExportPlan::Weight& weight = plan_.weights[w];
        if (!weight.is_drawn()) continue;
        const int map = plan_.maps[static_cast<std::size_t>(weight.map)].map;
        if (!render::IsDrawnOn(character_, rig().wrinkle_maps[static_cast<std::size_t>(map)],
                               group)) {
          continue;
        }
        maps.insert(weight.map);
        masks.insert(weight.mask);
        entry.weights.push_back(static_cast<int>(w));
      }
      if (entry.weights.empty()) continue;
      entry.name = Free(material.name, &taken);
      entry.maps.assign(maps.begin(), maps.end());
      entry.masks.assign(masks.begin(), masks.end());
      plan_.materials.push_back(std::move(entry));
    }
  }

  const character::Character& character_;
  ExportPlan plan_;
  std::map<std::string, int> map_of_;            // rig's name -> index into plan_.maps
  std::map<int, std::pair<int, int>> place_of_;  // region -> mask and channel
};

}  // namespace

Result<ExportPlan> PlanExport(const character::Character& character) {
  return Planner(character).Run();
}

std::string RegionsOf(const wrinkle::Rig& rig, const ExportPlan& plan, int mask, int channel) {
  std::string names;
  int last = -1;  // the weights of a region follow one another
  for (const ExportPlan::Weight& weight : plan.weights) {
    if (weight.mask != mask || weight.channel != channel || weight.region == last) continue;
    last = weight.region;
    names += (names.empty() ? "" : " ") + rig.regions[static_cast<std::size_t>(last)].name;
  }
  return names;
}

}  // namespace furrow::authoring
