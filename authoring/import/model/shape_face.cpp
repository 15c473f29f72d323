// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/shape_face.h"

#include <algorithm>
#include <array>
#include <set>
#include <thread>
#include <utility>

#include <glm/geometric.hpp>

#include "authoring/bake/bake.h"
#include "authoring/bake/bake_embed.h"
#include "authoring/bake/bake_poses.h"
#include "authoring/bake/surface/bake_surface.h"
#include "authoring/bake/surface/surface_check.h"
#include "authoring/import/model/atlases.h"
#include "authoring/shapes/face_skin.h"
#include "authoring/shapes/region_masks.h"
#include "authoring/shapes/shape_landmarks.h"
#include "authoring/shapes/stroke_transfer.h"
#include "base/status.h"
#include "base/text.h"
#include "rig/shapes/arkit_shapes.h"

namespace furrow::authoring {
namespace {

using character::Character;
using character::Material;
using Kind = wrinkle::Driver::Kind;

std::string Listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

// Other materials are skin only if none is marked as skin. The face is then marked, so that hair,
// teeth and clothes that nobody marked do not wrinkle.
void MarkFace(int material, Character* character) {
  if (material < 0) return;
  Material& face = character->materials[static_cast<std::size_t>(material)];
  face.kind = Material::Kind::kSkin;
  face.wrinkles = true;
}

// The body's part of a rig: what joints of the body drive on cloth.
class BodyPart {
 public:
  explicit BodyPart(wrinkle::Rig rig, bool has_cloth) : rig_(std::move(rig)) {
    std::erase_if(rig_.drivers, [&](const wrinkle::Driver& driver) {
      return !has_cloth || driver.kind == Kind::kPose || driver.kind == Kind::kStrain ||
             driver.kind == Kind::kBlendShape;
    });
    for (const wrinkle::Driver& driver : rig_.drivers) drivers_.insert(driver.name);
    for (wrinkle::Region& region : rig_.regions) Prune(&region);
    std::erase_if(rig_.regions, [](const auto& region) { return region.feeds.empty(); });
    for (const wrinkle::Region& region : rig_.regions) {
      regions_.insert(region.name);
      for (const wrinkle::Feed& feed : region.feeds) maps_.insert(feed.map);
    }
  }

  void AddTo(wrinkle::Rig* rig) {
    for (wrinkle::Driver& driver : rig_.drivers) rig->drivers.push_back(std::move(driver));
    for (wrinkle::Region& region : rig_.regions) {
      std::erase_if(region.neighbours, [&](const auto& name) { return !regions_.contains(name); });
      rig->regions.push_back(std::move(region));
    }
    for (wrinkle::WrinkleMap& map : rig_.wrinkle_maps) {
      if (!maps_.contains(map.name)) continue;
      map.surface = wrinkle::WrinkleMap::Surface::kCloth;
      if (!maps_.contains(map.opposes)) map.opposes.clear();
      rig->wrinkle_maps.push_back(std::move(map));
    }
    rig->filter = rig_.filter;
  }

 private:
  // Maps of the face stay with the face.
  void Prune(wrinkle::Region* region) const {
    const bool of_face = std::any_of(kFaceRegions.begin(), kFaceRegions.end(),
                                     [&](const char* name) { return region->name == name; });
    for (wrinkle::Feed& feed : region->feeds) {
      std::erase_if(feed.sources, [&](const auto& s) { return !drivers_.contains(s.driver); });
    }
    std::erase_if(region->feeds, [&](const wrinkle::Feed& feed) {
      return of_face || feed.sources.empty() || feed.map == "stretch" || feed.map == "squash";
    });
  }

  wrinkle::Rig rig_;
  std::set<std::string> drivers_, regions_, maps_;
};

// Masks of the character itself instead of the default character's pictures.
void UseMasks(const std::array<std::string, 2>& pictures, wrinkle::Rig* rig) {
  for (wrinkle::Region& region : rig->regions) {
    for (std::size_t i = 0; i < kFaceRegions.size(); ++i) {
      if (region.name != kFaceRegions[i]) continue;
      region.mask = {};
      region.mask.texture = pictures[i / 4];
      region.mask.channel = static_cast<int>(i % 4);
    }
  }
  for (wrinkle::WrinkleMap& map : rig->wrinkle_maps) {
    map.normal.clear();
    map.derivative.clear();
    map.height.clear();
    map.colour.clear();
    map.cavity.clear();
  }
}

std::vector<std::string> MissingShapes(const FaceSkin& skin, const ArkitFace& face) {
  std::vector<std::string> missing, still;
  for (const std::string_view shape : rig::ArkitShapes()) {
    // These move eyes and tongue, which are not skin, or act on an open jaw only.
    if (shape.starts_with("eyeLook") || shape == "tongueOut" || shape == "mouthClose") continue;
    if (!face.Has(shape)) {
      missing.emplace_back(shape);
    } else if (skin.Moves(shape).empty()) {
      still.emplace_back(shape);
    }
  }
  std::vector<std::string> remarks;
  if (!missing.empty()) {
    remarks.push_back("the face lacks the blend shapes " + Listed(missing) +
                      "; they wrinkle it only where other shapes fold it");
  }
  if (!still.empty()) {
    remarks.push_back("the blend shapes " + Listed(still) + " exist, but do not move the skin");
  }
  return remarks;
}

}  // namespace

Result<std::vector<std::string>> ProposeShapeFace(const wrinkle::Rig& arkit, const ArkitFace& face,
                                                  int size, Character* character) {
  const auto skin = FaceSkin::Create(*character, face);
  FURROW_RETURN_IF_ERROR(skin);
  std::vector<std::string> remarks = MissingShapes(*skin, face);
  const FaceMasks masks = ProposeFaceMasks(*skin, FindShapeLandmarks(*skin));
  auto pictures = PaintFaceMasks(*character, *skin, masks, size);
  MarkFace(skin->material(), character);
  if (const auto without = ChooseAtlases(skin->material(), character); !without.empty()) {
    remarks.push_back("no wrinkles on " + Listed(without) +
                      ": their UVs overlap those of a material that has wrinkles");
  }
  wrinkle::Rig rig = arkit;
  rig.name = "proposed";
  rig.anchor = character->rig.anchor;
  UseMasks({AddRigPicture(std::move(pictures[0]), character),
            AddRigPicture(std::move(pictures[1]), character)},
           &rig);
  const bool has_cloth = !MeshesOn(*character, true).empty();
  if (!has_cloth && !character->rig.drivers.empty()) {
    remarks.emplace_back(
        "no material is cloth, so clothes do not fold; put 'cloth' into the names of their "
        "materials");
  }
  rig.reference_poses = character->rig.reference_poses;  // of the eyes
  BodyPart(std::move(character->rig), has_cloth).AddTo(&rig);
  character->rig = std::move(rig);
  return remarks;
}

Result<std::vector<std::string>> BakeShapeFace(const ArkitFace& face,
                                               std::span<const BakeStroke> strokes, int size,
                                               float depth,
                                               const std::function<bool(float)>& progress,
                                               Character* character) {
  std::vector<std::string> remarks;
  FURROW_RETURN_IF_ERROR(CheckSurfaces(*character, {}, &remarks));
  auto poses = CollectBakePoses(*character, {}, face);
  FURROW_RETURN_IF_ERROR(poses);
  remarks.insert(remarks.end(), poses->notes.begin(), poses->notes.end());
  const auto skin = FaceSkin::Create(*character, face);
  FURROW_RETURN_IF_ERROR(skin);
  const FaceMeasures measures = MeasureFace(*skin, FindShapeLandmarks(*skin));
  std::vector<BakeStroke> drawn = FirmCheeks();
  drawn.insert(drawn.end(), strokes.begin(), strokes.end());
  const TransferredStrokes moved =
      TransferStrokes(drawn, DefaultFaceMeasures(), measures, *skin, character->rig);
  if (moved.lost > 0) {
    remarks.push_back(Counted(moved.lost, "drawn fold") + " found no skin on this face");
  }
  BakeOptions options;
  options.size = size;
  options.depth = depth;
  options.threads = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 64);
  const auto maps = Bake(*character, poses->poses, moved.strokes, options, progress);
  FURROW_RETURN_IF_ERROR(maps);
  FURROW_RETURN_IF_ERROR(EmbedMaps(*maps, character));
  return remarks;
}

}  // namespace furrow::authoring
