// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/bake_package.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <utility>

#include "authoring/bake/bake_pictures.h"
#include "authoring/bake/layers/blood.h"
#include "authoring/paint/canvas.h"
#include "base/asset_path.h"
#include "base/files.h"
#include "base/status.h"
#include "character/package/package.h"
#include "character/pictures/picture_file.h"
#include "rig/rig_check.h"
#include "wrinkle/rig/rig_check.h"

namespace furrow::authoring {
namespace {

// Of one picture that the rig keeps.
constexpr std::size_t kMaxCopiedBytes = 256u << 20;

wrinkle::WrinkleMap* FindMap(wrinkle::Rig* rig, const std::string& name) {
  for (wrinkle::WrinkleMap& map : rig->wrinkle_maps) {
    if (map.name == name) return &map;
  }
  return nullptr;
}

// Collects the files of a bake and makes the rig name them.
class Packager {
 public:
  Packager(const character::Character& character, const BakedMaps& maps,
           const PackageOptions& options)
      : character_(character), maps_(maps), options_(options) {
    out_.rig = character.rig;
  }

  Result<BakedFiles> Run() {
    FURROW_RETURN_IF_ERROR(Release());
    for (const BakedMap& map : maps_.maps) {
      FURROW_RETURN_IF_ERROR(AddMap(map));
    }
    for (const bool cloth : {false, true}) {
      FURROW_RETURN_IF_ERROR(AddMasks(cloth));
    }
    FURROW_RETURN_IF_ERROR(rig::CheckRig(out_.rig));
    FURROW_RETURN_IF_ERROR(CopyPictures());
    return std::move(out_);
  }

 private:
  // Removes from the rig every picture that this bake replaces. The names that remain in use must
  // not be overwritten.
  Status Release() {
    std::map<std::string, std::set<bool>> surfaces;
    for (const BakedMap& baked : maps_.maps) {
      wrinkle::WrinkleMap* map = FindMap(&out_.rig, baked.map);
      if (map == nullptr) return {StatusCode::kInternal, "a baked map is missing from the rig"};
      map->normal.clear();
      map->derivative.clear();
      map->height.clear();
      map->cavity.clear();
      if (!baked.cloth) map->colour.clear();
      for (const BakedMask& mask : baked.masks) surfaces[mask.region].insert(baked.cloth);
    }
    for (wrinkle::Region& region : out_.rig.regions) {
      const auto found = surfaces.find(region.name);
      if (!options_.masks || found == surfaces.end()) continue;
      if (found->second.size() == 1) {
        region.mask = {};
        masked_.insert(region.name);
      } else {
        out_.notes.push_back(
            "region '" + region.name +
            "' folds on skin and on cloth, which have separate atlases; it keeps its "
            "own mask");
      }
    }
    for (std::string& name : character::RigPictureNames(out_.rig)) taken_.insert(std::move(name));
    for (const character::Picture& picture : character_.pictures) {
      const bool file = character_.FindRigPicture(picture.name) >= 0 &&
                        FindAsset(picture.name, character_.folder).ok();
      if (!file) taken_.insert(picture.name);  // the renderer looks inside the character first
    }
    return {};
  }

  // An unused name: "stem.png", or "stem_2.png" and so on.
  std::string Free(const std::string& stem, const std::string& extension) {
    std::string name = stem + extension;
    for (int i = 2; !taken_.insert(name).second; ++i) {
      name = stem + "_" + std::to_string(i) + extension;
    }
    return name;
  }

  Status AddMap(const BakedMap& baked) {
    wrinkle::WrinkleMap* map = FindMap(&out_.rig, baked.map);
    map->amplitude = 1.0f;
    FURROW_RETURN_IF_ERROR(AddDerivative(baked, map));
    FURROW_RETURN_IF_ERROR(AddHeight(baked, map));
    map->cavity = Free(baked.map + "_cavity", ".png");
    FURROW_RETURN_IF_ERROR(Add(CavityPicture(baked, map->cavity)));
    if (baked.cloth) return {};  // cloth holds no blood
    map->colour = Free(baked.map + "_colour", ".png");
    map->colour_scale = kBloodTintScale;
    return Add(ColourPicture(baked, map->colour_scale, map->colour));
  }

  // Skin and cloth have separate atlases, so the regions of each are packed separately.
  Status AddMasks(bool cloth) {
    std::map<std::string, BakedMask> masks;
    for (const BakedMap& baked : maps_.maps) {
      if (baked.cloth != cloth) continue;
      for (const BakedMask& mask : baked.masks) {
        if (options_.masks && !masked_.contains(mask.region)) continue;
        const auto [there, is_new] = masks.emplace(mask.region, mask);
        if (!is_new) Unite(mask.texels, &there->second.texels);
      }
    }
    const std::string stem =
        std::string(options_.masks ? "masks_" : "suggested_masks_") + (cloth ? "cloth_" : "skin_");
    std::vector<wrinkle::Region*> group;
    int pictures = 0;
    for (wrinkle::Region& region : out_.rig.regions) {
      if (masks.count(region.name) > 0) group.push_back(&region);
      const bool last = &region == &out_.rig.regions.back();
      if (group.size() < 4 && !(last && !group.empty())) continue;
      const std::string name = Free(stem + std::to_string(pictures++), ".png");
      const BakedMask& first = masks.at(group.front()->name);
      character::Picture picture = BlankPicture(name.c_str(), first.width, first.height, 4);
      FURROW_RETURN_IF_ERROR(AddMaskPicture(std::move(picture), group, masks));
      group.clear();
    }
    return {};
  }

  // Copies the pictures that the rig still names, so that the folder is complete without the
  // original character.
  Status CopyPictures() {
    for (const std::string& name : character::RigPictureNames(out_.rig)) {
      const auto named = [&](const BakedFiles::File& file) { return file.name == name; };
      if (std::any_of(out_.files.begin(), out_.files.end(), named)) continue;
      const auto path = FindAsset(name, character_.folder);
      if (!path.ok()) continue;  // embedded in the character, or missing
      Result<std::string> bytes = ReadFile(*path, kMaxCopiedBytes);
      FURROW_RETURN_IF_ERROR(bytes);
      out_.files.push_back({name, std::move(*bytes)});
    }
    return {};
  }

  Status Add(const character::Picture& picture) {
    const bool exr = !picture.pixels_float.empty();
    Result<std::string> bytes = exr ? character::EncodeExr(picture) : character::EncodePng(picture);
    FURROW_RETURN_IF_ERROR(bytes);
    out_.files.push_back({picture.name, std::move(*bytes)});
    return {};
  }

  [[nodiscard]] const char* Extension() const { return options_.exr ? ".exr" : ".png"; }

  static Status TooSteep(const wrinkle::WrinkleMap& map) {
    char text[96];
    std::snprintf(text, sizeof text,
                  "is too steep: its slopes reach %.0f, and a rig allows at most %.0f",
                  static_cast<double>(map.derivative_scale),
                  static_cast<double>(wrinkle::kMaxDerivativeScale));
    return {StatusCode::kInvalidArgument,
            "map '" + map.name + "' " + text,
            {},
            "make its strokes wider or shallower, or reduce --depth"};
  }

  Status AddDerivative(const BakedMap& baked, wrinkle::WrinkleMap* map) {
    map->derivative = Free(baked.map + "_derivative", Extension());
    // Floats store slopes directly. Integers need a scale just above the largest slope, to lose few
    // steps.
    map->derivative_scale = options_.exr ? 1.0f : RoundScale(baked.derivative, 0.25f);
    if (map->derivative_scale > wrinkle::kMaxDerivativeScale) return TooSteep(*map);
    if (!options_.exr) return Add(DerivativePicture(baked, map->derivative_scale, map->derivative));
    return Add(FloatPicture(baked, baked.derivative, map->derivative));
  }

  Status AddHeight(const BakedMap& baked, wrinkle::WrinkleMap* map) {
    map->height = Free(baked.map + "_height", Extension());
    map->height_mm = options_.exr ? 1.0f : RoundScale(baked.height_mm, 0.01f);
    if (!options_.exr) return Add(HeightPicture(baked, map->height_mm, map->height));
    return Add(FloatPicture(baked, baked.height_mm, map->height));
  }

  // Two maps may suggest masks for the same region: the larger value counts.
  static void Unite(const std::vector<float>& mask, std::vector<float>* all) {
    for (std::size_t i = 0; i < mask.size(); ++i) (*all)[i] = std::max((*all)[i], mask[i]);
  }

  Status AddMaskPicture(character::Picture picture, const std::vector<wrinkle::Region*>& regions,
                        const std::map<std::string, BakedMask>& masks) {
    const std::size_t texels = static_cast<std::size_t>(picture.width) * picture.height;
    for (std::size_t channel = 0; channel < regions.size(); ++channel) {
      const std::vector<float>& mask = masks.at(regions[channel]->name).texels;
      for (std::size_t i = 0; i < texels; ++i) {
        picture.pixels[4 * i + channel] = ToByte(mask[i]);
      }
      if (!options_.masks) continue;
      regions[channel]->mask.kind = wrinkle::Mask::Kind::kTexture;
      regions[channel]->mask.texture = picture.name;
      regions[channel]->mask.channel = static_cast<int>(channel);
    }
    return Add(picture);
  }

  const character::Character& character_;
  const BakedMaps& maps_;
  PackageOptions options_;
  std::set<std::string> masked_;  // regions that take a suggested mask
  std::set<std::string> taken_;   // names of pictures in use
  BakedFiles out_;
};

}  // namespace

float RoundScale(const std::vector<float>& values, float least) {
  float most = least;
  for (const float value : values) most = std::max(most, std::abs(value));
  // Rounds up to steps of 0.05 of the leading power of ten: 0.25, 0.3, 0.35, ...
  const float step = 0.05f * std::pow(10.0f, std::floor(std::log10(most)) + 1.0f);
  return std::ceil(most / step - 1e-4f) * step;
}

Result<BakedFiles> PackageMaps(const character::Character& character, const BakedMaps& maps,
                               const PackageOptions& options) {
  return Packager(character, maps, options).Run();
}

}  // namespace furrow::authoring
