// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/shape_face.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
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
#include "base/joined.h"
#include "base/status.h"
#include "base/text.h"
#include "rig/shapes/arkit_shapes.h"

namespace furrow::authoring {
namespace {

using character::Character;
using character::Material;
using Kind = wrinkle::Driver::Kind;

// The joints on both sides of a driver's bend: the skin between them folds. Of skin, only hinges
// and twists fold: a ball's four directions would fold the same place along and across.
struct Bend {
  std::vector<int> above;  // empty: all joints that are not below
  std::vector<int> below;
};

Bend BendOf(const wrinkle::Driver& driver, const wrinkle::Skeleton& skeleton) {
  Bend bend;
  const auto add = [&](const std::string& joint, std::vector<int>* joints) {
    if (const int index = skeleton.Find(joint); index >= 0) joints->push_back(index);
  };
  if (driver.kind == Kind::kHinge) {
    add(driver.hinge.parent, &bend.above);
    add(driver.hinge.joint, &bend.below);
  } else if (driver.kind == Kind::kTwist) {
    add(driver.twist.joint, &bend.below);
    for (const std::string& joint : driver.twist.through) add(joint, &bend.below);
  }
  return bend;
}

// The names of the drivers that bend skin: some of its vertices follow joints on both sides.
std::set<std::string> DriversOnSkin(const Character& character, const wrinkle::Rig& rig) {
  constexpr float kLeastShare = 0.1f;
  constexpr int kLeastVertices = 12;  // fewer are a rim below clothes
  std::set<std::string> drivers;
  for (const wrinkle::Driver& driver : rig.drivers) {
    const Bend bend = BendOf(driver, character.skeleton);
    if (bend.below.empty()) continue;
    const auto share = [](const character::Vertex& vertex, const std::vector<int>& joints) {
      float sum = 0.0f;
      for (int i = 0; i < 4; ++i) {
        if (std::find(joints.begin(), joints.end(), vertex.joints[i]) != joints.end()) {
          sum += vertex.skin_weights[i];
        }
      }
      return sum;
    };
    std::ptrdiff_t bent = 0;
    for (const int mesh : MeshesOn(character, false)) {
      const auto& vertices = character.meshes[static_cast<std::size_t>(mesh)].vertices;
      bent += std::count_if(vertices.begin(), vertices.end(), [&](const auto& vertex) {
        const float below = share(vertex, bend.below);
        const float above = bend.above.empty() ? 1.0f - below : share(vertex, bend.above);
        return below > kLeastShare && above > kLeastShare;
      });
    }
    if (bent >= kLeastVertices) drivers.insert(driver.name);
  }
  return drivers;
}

// The body's part of a rig: what joints of the body drive on cloth, and on skin that is bare.
class BodyPart {
 public:
  BodyPart(wrinkle::Rig rig, const Character& character)
      : rig_(std::move(rig)), has_cloth_(!MeshesOn(character, true).empty()) {
    std::erase_if(rig_.drivers, [](const wrinkle::Driver& driver) {
      return driver.kind == Kind::kPose || driver.kind == Kind::kStrain ||
             driver.kind == Kind::kBlendShape;
    });
    for (const wrinkle::Driver& driver : rig_.drivers) drivers_.insert(driver.name);
    on_skin_ = DriversOnSkin(character, rig_);
    for (wrinkle::Region& region : rig_.regions) Prune(&region);
    for (wrinkle::Region& region : rig_.regions) DrawOnSkin(&region);
    std::erase_if(rig_.regions, [](const auto& region) { return region.feeds.empty(); });
    KeepFed();
  }

  void AddTo(wrinkle::Rig* rig) {
    for (wrinkle::Driver& driver : rig_.drivers) rig->drivers.push_back(std::move(driver));
    for (wrinkle::Region& region : rig_.regions) {
      std::erase_if(region.neighbours, [&](const auto& name) { return !regions_.contains(name); });
      rig->regions.push_back(std::move(region));
    }
    for (const wrinkle::WrinkleMap& map : rig_.wrinkle_maps) {
      AddMap(map, map.name, wrinkle::WrinkleMap::Surface::kCloth, rig);
      AddMap(map, OnSkin(map.name), wrinkle::WrinkleMap::Surface::kSkin, rig);
    }
    rig->filter = rig_.filter;
  }

 private:
  static std::string OnSkin(const std::string& map) { return "skin_" + map; }

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

  // True if the map's weight ends at its peak: folds of a full bend, or of a driver without angles.
  // Cloth alone is slack at straight limbs and has folds that come and go with the angle.
  static bool IsDeepest(const wrinkle::Feed& feed) {
    return feed.angles.empty() ||
           std::ranges::max_element(feed.angles, {}, &wrinkle::CurvePoint::y) ==
               std::prev(feed.angles.end());
  }

  // Skin folds where cloth does at a full bend, by a map of its own that follows the driver's
  // value. A gain above 1 lets cloth fold early; skin does not. Nor does it fold in spirals.
  void DrawOnSkin(wrinkle::Region* region) const {
    std::vector<wrinkle::Feed> feeds = region->feeds;
    std::erase_if(feeds, [](const wrinkle::Feed& feed) {
      return !IsDeepest(feed) || feed.map.starts_with("twist_");
    });
    for (wrinkle::Feed& feed : feeds) {
      feed.map = OnSkin(feed.map);
      feed.angles.clear();
      std::erase_if(feed.sources, [&](const auto& s) {
        return !on_skin_.contains(s.driver) || s.value == "extended";
      });
      for (wrinkle::Feed::Source& source : feed.sources) source.gain = std::min(source.gain, 1.0f);
    }
    std::erase_if(feeds, [](const wrinkle::Feed& feed) { return feed.sources.empty(); });
    if (!has_cloth_) region->feeds.clear();
    region->feeds.insert(region->feeds.end(), feeds.begin(), feeds.end());
  }

  void KeepFed() {
    std::set<std::string> used;
    for (const wrinkle::Region& region : rig_.regions) {
      regions_.insert(region.name);
      for (const wrinkle::Feed& feed : region.feeds) {
        maps_.insert(feed.map);
        for (const wrinkle::Feed::Source& source : feed.sources) used.insert(source.driver);
      }
    }
    std::erase_if(rig_.drivers, [&](const auto& d) { return !used.contains(d.name); });
  }

  void AddMap(wrinkle::WrinkleMap map, const std::string& name,
              wrinkle::WrinkleMap::Surface surface, wrinkle::Rig* rig) const {
    if (!maps_.contains(name)) return;
    if (name != map.name) map.opposes = OnSkin(map.opposes);
    if (!maps_.contains(map.opposes)) map.opposes.clear();
    map.name = name;
    map.surface = surface;
    rig->wrinkle_maps.push_back(std::move(map));
  }

  wrinkle::Rig rig_;
  bool has_cloth_;
  std::set<std::string> drivers_, on_skin_, regions_, maps_;
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
    remarks.push_back("the face lacks the blend shapes " + Joined(missing) +
                      "; they wrinkle it only where other shapes fold it");
  }
  if (!still.empty()) {
    remarks.push_back("the blend shapes " + Joined(still) + " exist, but do not move the skin");
  }
  return remarks;
}

// Other materials are skin only if none is marked as skin. The face is then marked, so that hair,
// teeth and clothes that nobody marked do not wrinkle.
void MarkSkin(int material, Character* character) {
  if (material < 0) return;
  Material& face = character->materials[static_cast<std::size_t>(material)];
  face.kind = Material::Kind::kSkin;
  face.wrinkles = true;
}

}  // namespace

int MarkFace(const ArkitFace& face, Character* character) {
  const auto skin = FaceSkin::Create(*character, face);
  if (!skin.ok()) return -1;
  MarkSkin(skin->material(), character);
  return skin->material();
}

Result<std::vector<std::string>> ProposeShapeFace(const wrinkle::Rig& arkit, const ArkitFace& face,
                                                  int size, Character* character) {
  const auto skin = FaceSkin::Create(*character, face);
  FURROW_RETURN_IF_ERROR(skin);
  std::vector<std::string> remarks = MissingShapes(*skin, face);
  const FaceMasks masks = ProposeFaceMasks(*skin, FindShapeLandmarks(*skin));
  auto pictures = PaintFaceMasks(*character, *skin, masks, size);
  MarkSkin(skin->material(), character);
  if (const auto without = ChooseAtlases(skin->material(), character); !without.empty()) {
    remarks.push_back(
        "no wrinkles on " + Joined(without) +
        ": their UVs overlap those of a material that has wrinkles ('furrow character import' "
        "gives each material a tile of the atlas)");
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
  BodyPart(std::move(character->rig), *character).AddTo(&rig);
  character->rig = std::move(rig);
  return remarks;
}

Result<std::vector<std::string>> BakeShapeFace(const ArkitFace& face,
                                               std::span<const BakeStroke> strokes, int size,
                                               float depth,
                                               const std::function<bool(float)>& progress,
                                               Character* character) {
  std::vector<std::string> remarks;
  const auto bakeable = CheckSurfaces(*character, {}, &remarks);
  FURROW_RETURN_IF_ERROR(bakeable);
  auto poses = CollectBakePoses(*character, bakeable->names, face);
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
  const float own_depth = FoldDepthOf(measures);
  if (own_depth < 1.0f) {
    remarks.push_back(
        "the face is short below its eyes, as a child's or a drawn one, so its folds are " +
        std::to_string(std::lround(100.0f * own_depth)) +
        "% as deep as an adult's; --depth changes this");
  }
  options.skin.depth = depth * own_depth;
  options.threads = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 64);
  const auto maps = Bake(*character, poses->poses, moved.strokes, options, progress);
  FURROW_RETURN_IF_ERROR(maps);
  FURROW_RETURN_IF_ERROR(EmbedMaps(*maps, character));
  return remarks;
}

}  // namespace furrow::authoring
