// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/saved_parts.h"

#include <algorithm>
#include <array>
#include <utility>

#include "authoring/import/makehuman/picture_fit.h"
#include "base/ascii.h"
#include "base/srgb.h"
#include "base/text.h"

namespace furrow::authoring {
namespace {

using Kind = character::Material::Kind;

struct PartKind {
  std::string_view name;
  Kind kind;
  float roughness;
  std::string_view instead;  // what a character without the part has
};

constexpr std::array<PartKind, 7> kPartKinds{{
    {"eyes", Kind::kEye, 0.12f, "Furrow's own eyes are used"},
    {"hair", Kind::kHair, 0.45f, "Furrow's own short hair is used"},
    {"eyebrows", Kind::kHair, 0.6f, "the skin has painted brows"},
    {"eyelashes", Kind::kHair, 0.6f, "Furrow's own lashes are used"},
    {"teeth", Kind::kOther, 0.3f, "Furrow's own teeth are used"},
    {"tongue", Kind::kOther, 0.5f, "the tongue of the base mesh is used"},
    {"clothes", Kind::kCloth, 0.85f, "it is left out"},
}};

const PartKind& KindOf(std::string_view name) {
  const auto* found = std::find_if(kPartKinds.begin(), kPartKinds.end(),
                                   [&](const PartKind& kind) { return kind.name == name; });
  return found == kPartKinds.end() ? kPartKinds.back() : *found;
}

class PartReader {
 public:
  PartReader(const MhmSave& save, AssetLibrary* library, std::size_t num_base_vertices,
             int texture_size, std::vector<std::string>* warnings)
      : save_(save),
        library_(*library),
        num_base_vertices_(num_base_vertices),
        texture_size_(texture_size),
        warnings_(*warnings) {}

  std::optional<SavedPart> Read(const MhmSave::Part& wanted) {
    const auto file = library_.FindPart(wanted);
    if (!file) return Without(wanted, "is not in the data folder");
    Result<Proxy> proxy = ReadProxy(*file, num_base_vertices_);
    if (!proxy.ok()) return Without(wanted, "is not readable: " + proxy.status().ToString());
    SavedPart part;
    part.kind = wanted.kind;
    part.name = wanted.name;
    part.proxy = std::move(*proxy);
    if (const Status look = ReadLook(wanted, &part); !look.ok()) {
      if (wanted.kind != "clothes" && wanted.kind != "hair")
        return Without(wanted, "has no picture: " + look.ToString());
      warnings_.push_back("the picture of " + Named(wanted) + " is painted: " + look.ToString());
      part.painted = true;
    }
    return part;
  }

 private:
  static std::string Named(const MhmSave::Part& part) { return part.kind + " '" + part.name + "'"; }

  std::nullopt_t Without(const MhmSave::Part& part, const std::string& why) {
    warnings_.push_back(Named(part) + " " + why + "; " + std::string(KindOf(part.kind).instead));
    return std::nullopt;
  }

  // The save's choice, or the material that the part names itself.
  std::string MaterialPath(const MhmSave::Part& wanted, const SavedPart& part) const {
    for (const MhmSave::PartMaterial& material : save_.materials) {
      if (EqualsIgnoreCase(material.uuid, wanted.uuid) && !wanted.uuid.empty())
        return material.path;
    }
    for (const MhmSave::PartMaterial& material : save_.materials) {
      if (material.name == wanted.name) return material.path;
    }
    return part.proxy.fit.material;
  }

  Status ReadLook(const MhmSave::Part& wanted, SavedPart* part) {
    const std::string path = MaterialPath(wanted, *part);
    if (path.empty()) return {StatusCode::kNotFound, "the part names no material"};
    const auto found = library_.LoadMaterial(path, part->proxy.file.parent_path());
    if (!found.ok()) return found.status().At(part->proxy.file.string());
    const MhMaterial& material = found->material;
    part->tint = material.colour;
    part->transparent = material.transparent;
    part->double_sided = material.double_sided;
    if (material.colour_picture.empty())
      return {StatusCode::kNotFound, "the material names no picture", found->file.string()};
    auto colour = library_.LoadMaterialPicture(*found, material.colour_picture,
                                               wanted.kind + "_" + wanted.name);
    FURROW_RETURN_IF_ERROR(colour);
    part->colour = FitPicture(*colour, texture_size_);
    if (!material.normal_picture.empty() && part->kind == "clothes") ReadNormals(*found, part);
    return {};
  }

  // Clothes look well without them.
  void ReadNormals(const FoundMaterial& found, SavedPart* part) {
    auto normal = library_.LoadMaterialPicture(found, found.material.normal_picture,
                                               part->kind + "_" + part->name + "_normal");
    if (!normal.ok()) {
      warnings_.push_back("the normal map of " + part->kind + " '" + part->name +
                          "' is skipped: " + normal.status().ToString());
    } else if (normal->channels >= 3) {
      part->normal = FitPicture(*normal, texture_size_);
    }
  }

  const MhmSave& save_;
  AssetLibrary& library_;
  std::size_t num_base_vertices_;
  int texture_size_;
  std::vector<std::string>& warnings_;
};

// The mean of `picture` over the square of `width` texels around the UV (v down).
glm::vec4 MeanAt(const character::Picture& picture, const glm::vec2& uv, const glm::vec2& extent) {
  const auto samples = [](float texels) { return std::clamp(static_cast<int>(texels), 1, 8); };
  const int across = samples(extent.x * static_cast<float>(picture.width));
  const int down = samples(extent.y * static_cast<float>(picture.height));
  glm::vec4 sum(0.0f);
  for (int y = 0; y < down; ++y) {
    for (int x = 0; x < across; ++x) {
      const glm::vec2 offset((static_cast<float>(x) + 0.5f) / static_cast<float>(across) - 0.5f,
                             (static_cast<float>(y) + 0.5f) / static_cast<float>(down) - 0.5f);
      for (int c = 0; c < 3; ++c) sum[c] += ChannelAt(picture, uv + offset * extent, c);
    }
  }
  return sum / static_cast<float>(across * down);
}

}  // namespace

std::vector<SavedPart> ReadSavedParts(const MhmSave& save, AssetLibrary* library,
                                      std::size_t num_base_vertices, int texture_size,
                                      std::vector<std::string>* warnings) {
  PartReader reader(save, library, num_base_vertices, texture_size, warnings);
  std::vector<SavedPart> parts;
  for (const MhmSave::Part& wanted : save.parts) {
    auto part = reader.Read(wanted);
    if (!part) continue;
    // A person wears a garment once, and has one of everything else: the last.
    std::erase_if(parts, [&](const SavedPart& other) {
      return other.kind == part->kind &&
             (part->kind != "clothes" || other.proxy.file == part->proxy.file);
    });
    parts.push_back(std::move(*part));
  }
  std::stable_sort(parts.begin(), parts.end(), [](const SavedPart& a, const SavedPart& b) {
    return a.proxy.fit.z_depth < b.proxy.fit.z_depth;
  });
  return parts;
}

bool HasKind(std::span<const SavedPart> parts, std::string_view kind) {
  return std::any_of(parts.begin(), parts.end(),
                     [&](const SavedPart& part) { return part.kind == kind; });
}

std::vector<bool> HiddenBy(std::span<const SavedPart> parts) {
  std::vector<bool> hidden;
  for (const SavedPart& part : parts) {
    if (part.kind != "clothes") continue;
    const std::vector<bool>& deleted = part.proxy.fit.deleted;
    hidden.resize(std::max(hidden.size(), deleted.size()), false);
    for (std::size_t v = 0; v < deleted.size(); ++v) hidden[v] = hidden[v] || deleted[v];
  }
  return hidden;
}

character::Material MaterialOf(const SavedPart& part) {
  const PartKind& kind = KindOf(part.kind);
  character::Material material;
  material.name = part.kind + "_" + part.name;
  material.kind = kind.kind;
  material.roughness = kind.roughness;
  for (int c = 0; c < 3 && !part.painted; ++c)
    material.base_colour[c] = LinearFromSrgb(part.tint[c]);
  material.double_sided =
      part.double_sided || kind.kind == Kind::kCloth || kind.kind == Kind::kHair;
  const bool alpha = part.painted ? part.kind == "hair" : part.colour && part.colour->channels == 4;
  if (alpha && (part.transparent || kind.kind == Kind::kHair)) material.alpha_cutoff = 0.4f;
  return material;
}

std::optional<character::Picture> ReadSavedSkin(const MhmSave& save, const AssetLibrary& library,
                                                std::vector<std::string>* warnings) {
  if (save.skin_material.empty()) return std::nullopt;
  const auto painted = [&](const Status& why) {
    warnings->push_back("the skin '" + save.skin_material + "' is painted: " + why.ToString());
    return std::nullopt;
  };
  const auto found = library.LoadMaterial(save.skin_material, {});
  if (!found.ok()) return painted(found.status());
  // MakeHuman's default skin has no picture, and nothing is lost by painting it.
  if (found->material.colour_picture.empty()) return std::nullopt;
  auto picture = library.LoadMaterialPicture(*found, found->material.colour_picture, "skin_colour");
  if (!picture.ok()) return painted(picture.status());
  if (picture->channels < 3)
    return painted({StatusCode::kUnsupported, "the picture has no colour", found->file.string()});
  return FitPicture(*picture, character::kMaxPictureSide);
}

character::Picture MoveSkinPicture(const character::Picture& picture,
                                   const std::vector<SurfaceTexel>& texels,
                                   std::span<const UvMove> moves, int size) {
  return FillPicture("skin_colour", texels, size, 3, [&](const SurfaceTexel& texel) {
    const float scale = 1.0f / static_cast<float>(size);
    glm::vec2 uv =
        (glm::vec2(static_cast<float>(texel.x), static_cast<float>(texel.y)) + 0.5f) * scale;
    uv.y = 1.0f - uv.y;  // v up, as in .obj
    glm::vec2 extent(scale);
    for (const UvMove& move : moves) {
      if (uv.x > move.to_high.x + scale) continue;
      const glm::vec2 stretch = (move.from_high - move.from_low) / (move.to_high - move.to_low);
      uv = move.from_low + (uv - move.to_low) * stretch;
      extent *= stretch;
      break;
    }
    return MeanAt(picture, {uv.x, 1.0f - uv.y}, extent);
  });
}

}  // namespace furrow::authoring
