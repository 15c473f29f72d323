// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "character/character.h"
#include "render/request/frame_request.h"
#include "render/request/subjects.h"
#include "render/wrinkles/dynamic_masks.h"

namespace furrow::render {

// Which surfaces a wrinkle map is drawn on: those that its rig says (WrinkleMap::surface). What is
// meant for cloth goes on skin where the character wears none. Eyes and hair have no wrinkles;
// other materials count as skin where the character marks no skin, and else have none.
enum class WrinkleGroup { kSkin, kCloth, kNone };
inline constexpr int kNumWrinkleGroups = 2;  // kNone has no table

// One wrinkle map that this frame needs. Mirrors ActiveMap of shaders/wrinkles/wrinkles.glsl
// (std140).
struct ActiveMap {
  glm::vec4 colour{1.0f};  // rgb: of the views; a: WrinkleMap::colour_scale
  std::int32_t layer = 0;
  std::int32_t map = 0;
  float amplitude = 1.0f;
  std::int32_t height_layer = -1;  // -1: the map has no heights
};
static_assert(sizeof(ActiveMap) == 32);

// The active list of one group of surfaces, as the shaders read it: the maps that some subject of
// the frame needs, first those of which a mask slides, then those of which vertices bring another
// mask, then those with painted masks alone.
struct WrinkleTable {
  std::vector<ActiveMap> maps;
  std::size_t num_sliding = 0;                  // those of which a mask slides
  std::size_t num_dynamic = 0;                  // those of which vertices bring any mask
  std::vector<glm::vec4> mask_weights;          // subjects x maps x mask layers
  std::vector<DynamicMaskBlock> dynamic_masks;  // subject after subject
  std::vector<std::uint32_t> first_masks;       // where each subject's begin, and the end
  bool uses_texture = false;
  bool uses_dynamic = false;
  bool paints_sliding = false;  // some of which a mask slides have painted masks as well
  bool paints_dynamic = false;  // ... and some of which vertices bring any mask
  bool has_heights = false;     // of some map
};

// Where the character's textures put the masks and maps of its rig.
struct WrinkleLayout {
  struct MaskTexture {
    std::string name;
    int layer = 0;
  };
  std::vector<MaskTexture> masks;
  std::vector<int> map_layers;     // a map of the rig -> layer of the derivative array, -1: none
  std::vector<int> height_layers;  // ... of the array of heights; empty: no map has any
  int num_mask_layers = 1;         // of the array; 1 where there is no mask at all

  [[nodiscard]] int MaskLayer(std::string_view texture) const;  // -1: no such
};

// vec4s that carry the dynamic masks of `num_maps` maps: MAP_SLOTS of the shaders.
[[nodiscard]] constexpr int MapSlots(int num_maps) { return num_maps < 1 ? 1 : (num_maps + 3) / 4; }
// Of a WrinkleTable's maps: all, or those alone of which vertices bring a mask, or a mask slides.
enum class WrinklePart { kAll, kDynamic, kSliding };
inline constexpr int kNumWrinkleParts = 3;
struct WrinkleNeeds {
  std::size_t num_maps = 0;  // the first of the table
  bool uses_texture = false;
  bool uses_dynamic = false;
};
[[nodiscard]] WrinkleNeeds NeedsOf(const WrinkleTable& table, WrinklePart part);
// The dynamic masks of a part, and where each subject's begin, and the end.
struct PartMasks {
  std::vector<DynamicMaskBlock> masks;
  std::vector<std::uint32_t> first;
};
[[nodiscard]] PartMasks MasksOf(const WrinkleTable& table, WrinklePart part);

// ACTIVE_MAPS of the shaders for so many of a rig's `num_maps`: a power of two, so that a face that
// begins to move does not wait for one program after the other. The rest of the list is zeros,
// which add nothing.
[[nodiscard]] int PaddedMaps(std::size_t active, int num_maps);

// The WrinkleTable block of shaders/wrinkles/wrinkles.glsl, byte for byte (std140), and its size. Its
// mask weights are those of the first subject.
[[nodiscard]] std::size_t WrinkleBlockSize(int num_maps, int num_mask_layers);
[[nodiscard]] std::vector<std::uint8_t> WrinkleBlock(const WrinkleTable& table, WrinklePart part,
                                                     int num_maps, const WrinkleLayout& layout);
// u_subject_weights of shaders/wrinkles/masks.glsl: all subjects' mask weights, a row as long as the
// block's each.
[[nodiscard]] std::vector<glm::vec4> SubjectWeights(const WrinkleTable& table, int num_maps,
                                                    const WrinkleLayout& layout);

[[nodiscard]] WrinkleGroup GroupOf(const character::Character& character,
                                   character::Material::Kind kind);

// Turns the wrinkle weights and driver values of a request's subjects into what the shaders read.
//
// Values go by name from the request's binding to the character's own rig, bound to its own
// skeleton: a stream may have other joints than the character, and its rig other drivers besides
// the shared ones.
class WrinkleTables {
 public:
  // `character` outlives the tables. Errors: those of wrinkle::RigBinding::Create.
  [[nodiscard]] static Result<std::unique_ptr<WrinkleTables>> Create(
      const character::Character& character, WrinkleLayout layout);

  // kInvalidArgument: a span of a subject is shorter than its binding's names; `where` says which.
  [[nodiscard]] Status Update(const FrameRequest& request);

  [[nodiscard]] const WrinkleTable& table(WrinkleGroup group) const {
    return tables_[static_cast<int>(group)];
  }
  // Some map in the table moves the group's surfaces.
  [[nodiscard]] bool IsDisplaced(WrinkleGroup group, const Settings& settings) const;
  [[nodiscard]] int num_maps() const { return static_cast<int>(maps_.size()); }
  // subjects x joints x mask_columns(): how much each joint raises each column of dynamic masks.
  [[nodiscard]] std::span<const float> influences() const { return influences_; }
  [[nodiscard]] int mask_columns() const { return dynamic_.num_columns(); }
  // How much a joint of the first subject raises a column.
  [[nodiscard]] float influence(int joint, int column) const {
    return influences_[static_cast<std::size_t>(joint * mask_columns() + column)];
  }
  // The masks that the last Update() asked for.
  [[nodiscard]] MaskMode mask_mode() const { return mask_mode_; }
  // What joints may raise of dynamic masks, in any pose, on the group's surfaces; by mask_mode().
  [[nodiscard]] std::vector<SkinnedShare> skinned(WrinkleGroup group) const;
  // Mask layers x 4 channels: each region's colour for the view mask_texture; black for channels of
  // regions that are not drawn on the group's surfaces. kNone: all black.
  [[nodiscard]] std::span<const glm::vec4> mask_palette(WrinkleGroup group) const {
    return palettes_[static_cast<int>(group)];
  }
  // A map of the rig that is painted on the group's surfaces, and the channel that masks it there:
  // four a mask layer.
  struct Painted {
    int map = 0;
    int channel = 0;
  };
  [[nodiscard]] std::vector<Painted> painted(WrinkleGroup group) const;
  // A bit a mask layer: 1 where it holds a region that is drawn on the group's surfaces.
  [[nodiscard]] std::uint32_t mask_bits(WrinkleGroup group) const {
    return mask_bits_[static_cast<int>(group)];
  }

 private:
  struct MapInfo {
    ActiveMap entry;
    bool in_group[kNumWrinkleGroups] = {};
  };
  // One "<region>.<map>" of the rig, in the order of RigBinding::weight_names().
  struct WeightSlot {
    int map = -1;
    int mask_layer = -1;  // -1: the region has no texture mask
    int channel = 0;
  };
  // What one subject needs, of all groups of surfaces.
  struct SubjectWrinkles {
    std::vector<glm::vec4> rows;          // maps x mask layers
    std::vector<bool> textured;           // a map each: some weight of its row is above 0
    std::vector<DynamicMaskBlock> masks;  // whose slot is a map
  };
  // Where the values of one list of names are in another; -1: not there.
  struct NameMap {
    std::vector<std::string> source;
    std::vector<int> source_index;  // one a target name
    void Match(std::span<const std::string> from, std::span<const std::string> to);
    void Carry(std::span<const float> from, std::span<float> to) const;
  };

  WrinkleTables(const character::Character& character, WrinkleLayout layout,
                wrinkle::RigBinding binding, wrinkle::RigBinding skinning);
  void DescribeMaps(const character::Character& character);
  void DescribeRegions(const wrinkle::Rig& rig);
  void DescribePalettes(const wrinkle::Rig& rig);
  [[nodiscard]] Status CarryValues(const NamedSubject& named);
  void AddSubject(MaskMode mode);
  // What masks a map in this frame, the first of the list that does.
  enum class Source { kSliding, kSkinned, kPainted };
  void FindSources();
  [[nodiscard]] bool IsTextured(std::size_t map) const;
  void ListMaps(int group, float strength, Source source, std::vector<int>* slots);
  void FillTable(int group, float strength);

  WrinkleLayout layout_;
  wrinkle::RigBinding binding_;   // the character's rig on its own skeleton
  wrinkle::RigBinding skinning_;  // the same without painted masks: MaskMode::kDynamic
  DynamicMasks dynamic_{&binding_, &skinning_};
  MaskMode mask_mode_ = MaskMode::kRig;
  std::vector<MapInfo> maps_;
  std::vector<Source> sources_;  // by map, of the frame
  std::vector<WeightSlot> slots_;
  std::vector<glm::vec4> palettes_[kNumWrinkleGroups + 1];
  std::uint32_t mask_bits_[kNumWrinkleGroups + 1] = {};
  NameMap weight_map_;
  NameMap value_map_;
  std::vector<float> weights_;  // of binding_, of the subject that is being added
  std::vector<float> values_;   // driver values of binding_
  std::vector<SubjectWrinkles> subjects_;
  std::vector<float> influences_;
  WrinkleTable tables_[kNumWrinkleGroups];
};

}  // namespace furrow::render
