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

// The surfaces that a wrinkle map is drawn on, as its rig says (WrinkleMap::surface). Maps for
// cloth are drawn on skin if the character has no cloth. Eyes and hair have no wrinkles. Other
// materials count as skin if the character marks no material as skin; otherwise they have no
// wrinkles. Materials without Material::wrinkles have none either.
enum class WrinkleGroup { kSkin, kCloth, kNone };
inline constexpr int kNumWrinkleGroups = 2;  // kNone has no table

// A wrinkle map that the current frame needs. Mirrors ActiveMap of shaders/wrinkles/wrinkles.glsl
// (std140).
struct ActiveMap {
  glm::vec4 colour{1.0f};          // rgb: colour in debug views; a: WrinkleMap::colour_scale
  std::int32_t layer = 0;          // of the derivative array
  std::int32_t map = 0;            // index in Rig::wrinkle_maps
  float amplitude = 1.0f;          // factor of the map's slopes
  std::int32_t height_layer = -1;  // -1: the map has no heights
};
static_assert(sizeof(ActiveMap) == 32);

// The active wrinkle maps of one group of surfaces, as the shaders read them: all maps that at
// least one subject of the frame needs. Maps with a sliding mask come first, then maps with another
// vertex mask, then maps with painted masks only.
struct WrinkleTable {
  std::vector<ActiveMap> maps;
  std::size_t num_sliding = 0;                  // number of maps with a sliding mask
  std::size_t num_dynamic = 0;                  // number of maps with any vertex mask
  std::vector<glm::vec4> mask_weights;          // subjects x maps x mask layers
  std::vector<DynamicMaskBlock> dynamic_masks;  // one subject after another
  std::vector<std::uint32_t> first_masks;       // start of each subject's masks, and the end
  bool uses_texture = false;
  bool uses_dynamic = false;
  bool paints_sliding = false;  // a map with a sliding mask also has a painted one
  bool paints_dynamic = false;  // a map with any vertex mask also has a painted one
  bool has_heights = false;     // at least one map has heights
};

// Assigns the masks and maps of a rig to layers of the character's textures.
struct WrinkleLayout {
  struct MaskTexture {
    std::string name;
    int layer = 0;
  };
  std::vector<MaskTexture> masks;
  std::vector<int> map_layers;     // layer of the derivative array per map of the rig; -1: none
  std::vector<int> height_layers;  // the same for the array of heights; empty: none
  int num_mask_layers = 1;         // of the array; at least 1, even without masks

  [[nodiscard]] int MaskLayer(std::string_view texture) const;  // -1: unknown name
};

// Number of vec4s that hold the dynamic masks of `num_maps` maps: MAP_SLOTS of the shaders.
[[nodiscard]] constexpr int MapSlots(int num_maps) { return num_maps < 1 ? 1 : (num_maps + 3) / 4; }
// A part of a WrinkleTable: all maps, only maps with a vertex mask, or only maps with a sliding
// mask.
enum class WrinklePart { kAll, kDynamic, kSliding };
inline constexpr int kNumWrinkleParts = 3;
// What the shaders need for a part of a table.
struct WrinkleNeeds {
  std::size_t num_maps = 0;  // the first maps of the table
  bool uses_texture = false;
  bool uses_dynamic = false;
};
[[nodiscard]] WrinkleNeeds NeedsOf(const WrinkleTable& table, WrinklePart part);
// The dynamic masks of a part; `first` holds the start of each subject's masks, and the end.
struct PartMasks {
  std::vector<DynamicMaskBlock> masks;
  std::vector<std::uint32_t> first;
};
[[nodiscard]] PartMasks MasksOf(const WrinkleTable& table, WrinklePart part);

// ACTIVE_MAPS of the shaders for `active` of a rig's `num_maps` maps, rounded up to a power of two.
// When more and more maps become active, few different programs are compiled. The padding is zero
// and adds nothing.
[[nodiscard]] int PaddedMaps(std::size_t active, int num_maps);

// The WrinkleTable block of shaders/wrinkles/wrinkles.glsl, byte for byte (std140), and its size.
// The block holds the mask weights of the first subject.
[[nodiscard]] std::size_t WrinkleBlockSize(int num_maps, int num_mask_layers);
[[nodiscard]] std::vector<std::uint8_t> WrinkleBlock(const WrinkleTable& table, WrinklePart part,
                                                     int num_maps, const WrinkleLayout& layout);
// u_subject_weights of shaders/wrinkles/masks.glsl: the mask weights of all subjects, each as many
// rows as in the block.
[[nodiscard]] std::vector<glm::vec4> SubjectWeights(const WrinkleTable& table, int num_maps,
                                                    const WrinkleLayout& layout);

// The group of a material of this character.
[[nodiscard]] WrinkleGroup GroupOf(const character::Character& character,
                                   const character::Material& material);
// Returns true if a wrinkle map of the character's rig is drawn on the group's surfaces.
[[nodiscard]] bool IsDrawnOn(const character::Character& character, const wrinkle::WrinkleMap& map,
                             WrinkleGroup group);

// Converts the wrinkle weights and driver values of a request's subjects to the tables that the
// shaders read.
//
// Values are matched by name between the request's binding and the character's own rig, which is
// bound to the character's own skeleton. A stream may have other joints than the character, and its
// rig may have additional drivers.
class WrinkleTables {
 public:
  // `character` must outlive the tables. Errors: those of wrinkle::RigBinding::Create.
  [[nodiscard]] static Result<std::unique_ptr<WrinkleTables>> Create(
      const character::Character& character, WrinkleLayout layout);

  // Replaces the tables by those of a request. Error: kInvalidArgument (a span of a subject is
  // shorter than its binding's list of names); `where` is the field.
  [[nodiscard]] Status Update(const FrameRequest& request);

  [[nodiscard]] const WrinkleTable& table(WrinkleGroup group) const {
    return tables_[static_cast<int>(group)];
  }
  // Returns true if a map in the table displaces the group's surfaces.
  [[nodiscard]] bool IsDisplaced(WrinkleGroup group, const Settings& settings) const;
  [[nodiscard]] int num_maps() const { return static_cast<int>(maps_.size()); }
  // subjects x joints x mask_columns(): how strongly each joint raises each column of dynamic
  // masks.
  [[nodiscard]] std::span<const float> influences() const { return influences_; }
  [[nodiscard]] int mask_columns() const { return dynamic_.num_columns(); }
  // The influence of a joint of the first subject on a column.
  [[nodiscard]] float influence(int joint, int column) const {
    return influences_[static_cast<std::size_t>(joint * mask_columns() + column)];
  }
  // The mask mode of the last Update().
  [[nodiscard]] MaskMode mask_mode() const { return mask_mode_; }
  // All (joint, column) pairs that can raise dynamic masks on the group's surfaces in some pose,
  // for mask_mode().
  [[nodiscard]] std::vector<SkinnedShare> skinned(WrinkleGroup group) const;
  // Mask layers x 4 channels: each region's colour in the view mask_texture. Black for channels of
  // regions that are not drawn on the group's surfaces, and always for kNone.
  [[nodiscard]] std::span<const glm::vec4> mask_palette(WrinkleGroup group) const {
    return palettes_[static_cast<int>(group)];
  }
  // A wrinkle map that is drawn on the group's surfaces, and the mask channel (four per layer) that
  // masks it.
  struct Painted {
    int map = 0;
    int channel = 0;
  };
  [[nodiscard]] std::vector<Painted> painted(WrinkleGroup group) const;
  // One bit per mask layer: 1 if the layer holds a region that is drawn on the group's surfaces.
  [[nodiscard]] std::uint32_t mask_bits(WrinkleGroup group) const {
    return mask_bits_[static_cast<int>(group)];
  }

 private:
  struct MapInfo {
    ActiveMap entry;
    bool in_group[kNumWrinkleGroups] = {};
  };
  // One weight "<region>.<map>" of the rig, in the order of RigBinding::weight_names().
  struct WeightSlot {
    int map = -1;
    int mask_layer = -1;  // -1: the region has no painted mask
    int channel = 0;
  };
  // The wrinkles of one subject, for all groups of surfaces.
  struct SubjectWrinkles {
    std::vector<glm::vec4> rows;          // maps x mask layers
    std::vector<bool> textured;           // per map: some weight of its row is above 0
    std::vector<DynamicMaskBlock> masks;  // their slot is the map
  };
  // Maps one list of names to another by index; -1: not in the source list.
  struct NameMap {
    std::vector<std::string> source;
    std::vector<int> source_index;  // one per target name
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
  // The source of a map's mask in this frame. If several apply, the first in this order counts.
  enum class Source { kSliding, kSkinned, kPainted };
  void FindSources();
  [[nodiscard]] bool IsTextured(std::size_t map) const;
  void ListMaps(int group, float strength, Source source, std::vector<int>* slots);
  void FillTable(int group, float strength);

  WrinkleLayout layout_;
  wrinkle::RigBinding binding_;   // the character's rig on its own skeleton
  wrinkle::RigBinding skinning_;  // the same with skinning masks for the painted ones:
                                  // MaskMode::kDynamic
  DynamicMasks dynamic_{&binding_, &skinning_};
  MaskMode mask_mode_ = MaskMode::kRig;
  std::vector<MapInfo> maps_;
  std::vector<Source> sources_;  // per map, for this frame
  std::vector<WeightSlot> slots_;
  std::vector<glm::vec4> palettes_[kNumWrinkleGroups + 1];
  std::uint32_t mask_bits_[kNumWrinkleGroups + 1] = {};
  NameMap weight_map_;
  NameMap value_map_;
  std::vector<float> weights_;  // of binding_, for the subject that is being added
  std::vector<float> values_;   // driver values of binding_
  std::vector<SubjectWrinkles> subjects_;
  std::vector<float> influences_;
  WrinkleTable tables_[kNumWrinkleGroups];
};

}  // namespace furrow::render
