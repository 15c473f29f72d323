// SPDX-License-Identifier: Apache-2.0
#include "character/bake/bake_package.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "character/asset_path.h"

namespace furrow::character::bake {
namespace {

constexpr std::size_t kMaxCopiedBytes = 256u << 20;

template <class Planes>
Picture Sized(const Planes& planes, std::string name, int channels) {
  Picture picture;
  picture.name = std::move(name);
  picture.width = planes.width;
  picture.height = planes.height;
  picture.channels = channels;
  return picture;
}

// See wrinkle::WrinkleMap: a texel t stands for (2 t - 1) * scale.
std::uint16_t Signed16(float value, float scale) {
  const float t = 0.5f + 0.5f * std::clamp(value / scale, -1.0f, 1.0f);
  return static_cast<std::uint16_t>(std::lround(65535.0f * t));
}

std::uint8_t Unsigned8(float value) {
  return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
}

wrinkle::WrinkleMap* FindMap(wrinkle::Rig* rig, const std::string& name) {
  for (wrinkle::WrinkleMap& map : rig->wrinkle_maps) {
    if (map.name == name) return &map;
  }
  return nullptr;
}

// Collects the files of a bake, and makes its rig name them.
class Packager {
 public:
  Packager(const Character& character, const PackageOptions& options)
      : character_(character), options_(options) {
    out_.rig = character.rig;
  }

  Status AddMap(const BakedMap& baked) {
    wrinkle::WrinkleMap* map = FindMap(&out_.rig, baked.map);
    if (map == nullptr) return {StatusCode::kInternal, "a map was baked that the rig has not"};
    map->normal.clear();
    map->amplitude = 1.0f;
    if (Status s = AddDerivative(baked, map); !s.ok()) return s;
    if (Status s = AddHeight(baked, map); !s.ok()) return s;
    Picture cavity = Sized(baked, baked.map + "_cavity.png", 1);
    for (const float open : baked.cavity) cavity.pixels.push_back(Unsigned8(open));
    map->cavity = cavity.name;
    return Add(cavity);
  }

  // Skin and cloth have an atlas each, so regions are gathered by kind.
  Status AddMasks(const BakedMaps& maps, bool cloth) {
    std::map<std::string, BakedMask> masks;
    for (const BakedMap& baked : maps.maps) {
      if (baked.cloth != cloth) continue;
      for (const BakedMask& mask : baked.masks) {
        const auto [there, is_new] = masks.emplace(mask.region, mask);
        if (!is_new) Unite(mask.texels, &there->second.texels);
      }
    }
    std::vector<wrinkle::Region*> group;
    int pictures = 0;
    for (wrinkle::Region& region : out_.rig.regions) {
      if (masks.count(region.name) > 0) group.push_back(&region);
      const bool last = &region == &out_.rig.regions.back();
      if (group.size() < 4 && !(last && !group.empty())) continue;
      const std::string name =
          std::string(cloth ? "masks_cloth_" : "masks_skin_") + std::to_string(pictures++) + ".png";
      const BakedMask& first = masks.at(group.front()->name);
      if (Status s = AddMaskPicture(Sized(first, name, 4), group, masks); !s.ok()) return s;
      group.clear();
    }
    return {};
  }

  Status CopyPictures() {
    for (const std::string& name : RigPictureNames(out_.rig)) {
      const auto named = [&](const BakedFiles::File& file) { return file.name == name; };
      if (std::any_of(out_.files.begin(), out_.files.end(), named)) continue;
      const auto path = FindAsset(name, character_.folder);
      if (!path.ok()) continue;  // inside the character, or nowhere
      Result<std::string> bytes = ReadFile(*path, kMaxCopiedBytes);
      if (!bytes.ok()) return bytes.status();
      out_.files.push_back({name, std::move(*bytes)});
    }
    return {};
  }

  BakedFiles Take() { return std::move(out_); }

 private:
  Status Add(const Picture& picture) {
    const bool exr = !picture.pixels_float.empty();
    Result<std::string> bytes = exr ? EncodeExr(picture) : EncodePng(picture);
    if (!bytes.ok()) return bytes.status();
    out_.files.push_back({picture.name, std::move(*bytes)});
    return {};
  }

  Status AddDerivative(const BakedMap& baked, wrinkle::WrinkleMap* map) {
    map->derivative = baked.map + "_derivative" + (options_.exr ? ".exr" : ".png");
    map->derivative_scale = options_.exr ? 1.0f : RoundScale(baked.derivative, 0.25f);
    Picture picture = Sized(baked, map->derivative, options_.exr ? 2 : 3);
    if (options_.exr) {
      picture.pixels_float = baked.derivative;
      return Add(picture);
    }
    picture.pixels16.reserve(baked.derivative.size() / 2 * 3);
    for (std::size_t i = 0; i + 1 < baked.derivative.size(); i += 2) {
      picture.pixels16.push_back(Signed16(baked.derivative[i], map->derivative_scale));
      picture.pixels16.push_back(Signed16(baked.derivative[i + 1], map->derivative_scale));
      picture.pixels16.push_back(
          0);  // a PNG has no two channels that every reader takes for red, green
    }
    return Add(picture);
  }

  Status AddHeight(const BakedMap& baked, wrinkle::WrinkleMap* map) {
    map->height = baked.map + "_height" + (options_.exr ? ".exr" : ".png");
    map->height_mm = options_.exr ? 1.0f : RoundScale(baked.height_mm, 0.01f);
    Picture picture = Sized(baked, map->height, 1);
    if (options_.exr) {
      picture.pixels_float = baked.height_mm;
      return Add(picture);
    }
    picture.pixels16.reserve(baked.height_mm.size());
    for (const float mm : baked.height_mm) {
      picture.pixels16.push_back(Signed16(mm, map->height_mm));
    }
    return Add(picture);
  }

  static void Unite(const std::vector<float>& mask, std::vector<float>* all) {
    for (std::size_t i = 0; i < mask.size(); ++i) (*all)[i] = std::max((*all)[i], mask[i]);
  }

  Status AddMaskPicture(Picture picture, const std::vector<wrinkle::Region*>& regions,
                        const std::map<std::string, BakedMask>& masks) {
    const std::size_t texels = static_cast<std::size_t>(picture.width) * picture.height;
    picture.pixels.assign(4 * texels, 0);
    for (std::size_t channel = 0; channel < regions.size(); ++channel) {
      const std::vector<float>& mask = masks.at(regions[channel]->name).texels;
      for (std::size_t i = 0; i < texels; ++i) {
        picture.pixels[4 * i + channel] = Unsigned8(mask[i]);
      }
      if (!options_.masks) continue;
      regions[channel]->mask.kind = wrinkle::Mask::Kind::kTexture;
      regions[channel]->mask.texture = picture.name;
      regions[channel]->mask.channel = static_cast<int>(channel);
    }
    return Add(picture);
  }

  const Character& character_;
  PackageOptions options_;
  BakedFiles out_;
};

}  // namespace

float RoundScale(const std::vector<float>& values, float least) {
  float most = least;
  for (const float value : values) most = std::max(most, std::abs(value));
  // One significant digit and a half, upwards: 0.25, 0.3, 0.35, ...
  const float step = 0.05f * std::pow(10.0f, std::floor(std::log10(most)) + 1.0f);
  return std::ceil(most / step - 1e-4f) * step;
}

Result<BakedFiles> PackageMaps(const Character& character, const BakedMaps& maps,
                               const PackageOptions& options) {
  Packager packager(character, options);
  for (const BakedMap& map : maps.maps) {
    if (Status s = packager.AddMap(map); !s.ok()) return s;
  }
  for (const bool cloth : {false, true}) {
    if (Status s = packager.AddMasks(maps, cloth); !s.ok()) return s;
  }
  if (Status s = packager.CopyPictures(); !s.ok()) return s;
  return packager.Take();
}

}  // namespace furrow::character::bake
