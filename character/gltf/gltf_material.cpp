// SPDX-License-Identifier: Apache-2.0
#include "character/gltf/gltf_material.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <future>
#include <string>
#include <thread>
#include <utility>

#include "base/ascii.h"
#include "base/process/in_background.h"
#include "base/status.h"
#include "character/pictures/picture_file.h"
#include "character/source_notes.h"
#include "gltf/container/uri.h"

namespace furrow::character {
namespace {

using Kind = Material::Kind;

constexpr std::array<std::pair<std::string_view, Kind>, 6> kKindNames = {{{"skin", Kind::kSkin},
                                                                          {"cloth", Kind::kCloth},
                                                                          {"eye", Kind::kEye},
                                                                          {"hair", Kind::kHair},
                                                                          {"other", Kind::kOther},
                                                                          {"shade", Kind::kShade}}};

// The first match counts: "eyebrow" and "eyelash" are hair, not eyes.
constexpr std::array<std::pair<std::string_view, Kind>, 42> kHints = {
    {{"lash", Kind::kHair},     {"brow", Kind::kHair},      {"hair", Kind::kHair},
     {"beard", Kind::kHair},    {"eye", Kind::kEye},        {"cornea", Kind::kEye},
     {"iris", Kind::kEye},      {"teeth", Kind::kOther},    {"tooth", Kind::kOther},
     {"tongue", Kind::kOther},  {"mouth", Kind::kOther},    {"shoe", Kind::kOther},
     {"boot", Kind::kOther},    {"footwear", Kind::kOther}, {"glasses", Kind::kOther},
     {"helmet", Kind::kOther},  {"cloth", Kind::kCloth},    {"outfit", Kind::kCloth},
     {"garment", Kind::kCloth}, {"uniform", Kind::kCloth},  {"costume", Kind::kCloth},
     {"skirt", Kind::kCloth},   {"coat", Kind::kCloth},     {"hoodie", Kind::kCloth},
     {"blouse", Kind::kCloth},  {"shorts", Kind::kCloth},   {"vest", Kind::kCloth},
     {"sock", Kind::kCloth},    {"suit", Kind::kCloth},     {"shirt", Kind::kCloth},
     {"jeans", Kind::kCloth},   {"trouser", Kind::kCloth},  {"pants", Kind::kCloth},
     {"jacket", Kind::kCloth},  {"sweater", Kind::kCloth},  {"dress", Kind::kCloth},
     {"fabric", Kind::kCloth},  {"sleeve", Kind::kCloth},   {"skin", Kind::kSkin},
     {"face", Kind::kSkin},     {"head", Kind::kSkin},      {"body", Kind::kSkin}}};

Result<Picture> ReadPicture(const gltf::Document& document, std::size_t index,
                            const std::string& name) {
  const Result<gltf::EncodedImage> image = gltf::LocateImage(document, index);
  FURROW_RETURN_IF_ERROR(image);
  return image->file.empty() ? DecodePicture(name, image->bytes()) : LoadPicture(name, image->file);
}

std::string NameOf(const gltf::ImageSource& image) {
  return image.name.empty() && !gltf::IsDataUri(image.uri) ? image.uri : image.name;
}

// Texels of the longer side of a picture with Pictures::kColours.
constexpr int kMaxColourSide = 512;

// Decodes the images of a file in its order, and a few of them ahead of time on other threads,
// because decoding takes most of the time in which a character loads. Destroying it waits for them.
class PicturesAhead {
 public:
  // `wanted`: one per image; the others are not decoded.
  PicturesAhead(const gltf::Document& document, std::vector<bool> wanted, Pictures pictures)
      : document_(document), wanted_(std::move(wanted)), pictures_(pictures) {}

  [[nodiscard]] bool Wants(std::size_t index) const { return wanted_[index]; }
  // Call it once for each image that is wanted, in order.
  [[nodiscard]] Result<Picture> Next() {
    // Few, because each may decode to kMaxPicturePixels before the limit of all pictures is known
    // to be exceeded.
    static const std::size_t ahead = std::clamp(std::thread::hardware_concurrency(), 1u, 4u);
    for (; next_ < wanted_.size() && decoding_.size() < ahead; ++next_) {
      if (!wanted_[next_]) continue;
      decoding_.push_back(InBackground([this, index = next_] {
        auto picture = ReadPicture(document_, index, NameOf(document_.images()[index]));
        if (picture.ok() && pictures_ == Pictures::kColours) Reduce(kMaxColourSide, &*picture);
        return picture;
      }));
    }
    Result<Picture> picture = decoding_.front().get();
    decoding_.pop_front();
    return picture;
  }

 private:
  const gltf::Document& document_;
  const std::vector<bool> wanted_;
  const Pictures pictures_;
  std::size_t next_ = 0;
  std::deque<std::future<Result<Picture>>> decoding_;
};

// One per image: whether it is to be decoded.
std::vector<bool> WantedImages(std::size_t num_images, std::span<const gltf::Material> materials,
                               Pictures pictures) {
  std::vector<bool> wanted(num_images, pictures == Pictures::kLoad);
  if (pictures != Pictures::kColours) return wanted;
  for (const gltf::Material& material : materials) {
    const auto image = static_cast<std::size_t>(material.base_colour_image);
    if (material.base_colour_image >= 0 && image < num_images) wanted[image] = true;
  }
  return wanted;
}

// Furrow's own files state the kind; for others, the name is the only hint.
Kind KindOf(const gltf::Material& material) {
  for (const auto& [name, kind] : kKindNames) {
    if (material.kind == name) return kind;
  }
  return GuessMaterialKind(material.name);
}

}  // namespace

Kind GuessMaterialKind(std::string_view name) {
  const std::string lower = AsciiLower(std::string(name));
  for (const auto& [hint, kind] : kHints) {
    if (lower.find(hint) != std::string::npos) return kind;
  }
  return Kind::kOther;
}

std::string_view MaterialKindName(Kind kind) {
  return kKindNames[static_cast<std::size_t>(kind)].first;
}

Result<std::vector<Picture>> ReadGltfPictures(const gltf::Document& document,
                                              std::span<const gltf::Material> materials,
                                              const ReadOptions& options) {
  std::vector<Picture> pictures;
  PicturesAhead ahead(document, WantedImages(document.images().size(), materials, options.pictures),
                      options.pictures);
  std::int64_t pixels = 0;
  for (std::size_t i = 0; i < document.images().size(); ++i) {
    const std::string where = "images[" + std::to_string(i) + "]";
    const std::string name = NameOf(document.images()[i]);
    if (!ahead.Wants(i)) {
      pictures.push_back(Undecoded(name));
      continue;
    }
    Result<Picture> picture = ahead.Next();
    if (!picture.ok() && options.lenient && picture.status().code() != StatusCode::kLimit) {
      if (options.notes != nullptr) {
        options.notes->missing_pictures.push_back(name + ": " + picture.status().what());
      }
      pictures.push_back(Undecoded(name));
      continue;
    }
    if (!picture.ok()) {
      const Status s = picture.status();
      return Status(s.code(), s.where().empty() ? s.what() : s.where() + ": " + s.what(), where,
                    s.todo());
    }
    pixels += static_cast<std::int64_t>(picture->width) * picture->height;
    // Small files can decode to huge pictures, so the sum is bounded too.
    if (pixels > 4 * kMaxPicturePixels) {
      return Status(StatusCode::kLimit,
                    "the pictures up to this one have " + std::to_string(pixels) +
                        " pixels; at most " + std::to_string(4 * kMaxPicturePixels) +
                        " are accepted",
                    where, "reduce the size of the pictures");
    }
    pictures.push_back(std::move(*picture));
  }
  return pictures;
}

std::vector<Material> MakeGltfMaterials(const std::vector<gltf::Material>& from) {
  std::vector<Material> materials;
  for (const gltf::Material& material : from) {
    Material& to = materials.emplace_back();
    to.name = material.name;
    to.kind = KindOf(material);
    to.wrinkles = material.wrinkles;
    to.base_colour = material.base_colour;
    to.base_colour_texture = material.base_colour_image;
    to.normal_texture = material.normal_image;
    to.roughness = material.roughness;
    to.roughness_texture = material.roughness_image;
    to.emission = material.emission;
    to.emission_texture = material.emission_image;
    to.thickness = material.thickness;
    to.thickness_texture = material.thickness_image;
    // The transform of any other material moves the UVs of its meshes (gltf_mesh.cpp).
    if (material.is_atlas_tile) {
      to.texture_scale = material.uv_transform.scale;
      to.texture_offset = material.uv_transform.offset;
    }
    to.double_sided = material.double_sided;
    to.alpha_cutoff = material.alpha_cutoff;
  }
  return materials;
}

}  // namespace furrow::character
