// SPDX-License-Identifier: Apache-2.0
#include "render/wrinkles/wrinkle_table.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include <glm/vec3.hpp>

#include "base/status.h"

namespace furrow::render {
namespace {

using character::Material;

bool Has(const character::Character& character, Material::Kind kind) {
  return std::any_of(character.materials.begin(), character.materials.end(),
                     [&](const Material& material) { return material.kind == kind; });
}

// Colours of the thesis' figure 4.3: stretch is green and squash red. Other maps alternate between
// blue and amber.
glm::vec4 MapColour(std::string_view name, int index) {
  if (name == "stretch") return {0.05f, 0.8f, 0.1f, 1.0f};
  if (name == "squash") return {0.9f, 0.04f, 0.03f, 1.0f};
  return index % 2 == 0 ? glm::vec4{0.05f, 0.3f, 0.95f, 1.0f} : glm::vec4{0.95f, 0.5f, 0.02f, 1.0f};
}

// Evenly spaced hues at full saturation; `turn` in [0, 1).
glm::vec4 Hue(float turn) {
  const auto channel = [&](float shift) {
    const float x = std::abs(std::fmod(turn + shift, 1.0f) * 6.0f - 3.0f) - 1.0f;
    return std::clamp(x, 0.0f, 1.0f);
  };
  return {channel(0.0f), channel(2.0f / 3.0f), channel(1.0f / 3.0f), 1.0f};
}

// The same rig for MaskMode::kDynamic.
wrinkle::Rig WithSkinningMasks(wrinkle::Rig rig) {
  using Kind = wrinkle::Mask::Kind;
  for (wrinkle::Region& region : rig.regions) {
    if (region.mask.kind == Kind::kTexture) region.mask.kind = Kind::kSkinning;
  }
  return rig;
}

int FindMap(const wrinkle::Rig& rig, std::string_view name) {
  const auto found = std::find_if(rig.wrinkle_maps.begin(), rig.wrinkle_maps.end(),
                                  [&](const wrinkle::WrinkleMap& map) { return map.name == name; });
  return found == rig.wrinkle_maps.end() ? -1 : static_cast<int>(found - rig.wrinkle_maps.begin());
}

}  // namespace

int WrinkleLayout::MaskLayer(std::string_view texture) const {
  const auto found = std::find_if(masks.begin(), masks.end(),
                                  [&](const MaskTexture& mask) { return mask.name == texture; });
  return found == masks.end() ? -1 : found->layer;
}

// The block is sized for all maps of the rig and not for the active ones, so that one shader fits
// every frame.
std::size_t WrinkleBlockSize(int num_maps, int num_mask_layers) {
  const std::size_t maps = 4 * static_cast<std::size_t>(MapSlots(num_maps));
  return maps * (sizeof(ActiveMap) + sizeof(glm::vec4) * num_mask_layers);
}

// The table is sorted by kind of mask (FillTable()), so a part is a prefix of it.
WrinkleNeeds NeedsOf(const WrinkleTable& table, WrinklePart part) {
  switch (part) {
    case WrinklePart::kAll: break;
    case WrinklePart::kDynamic:
      return {table.num_dynamic, table.paints_dynamic, table.uses_dynamic};
    case WrinklePart::kSliding:
      return {table.num_sliding, table.paints_sliding, table.num_sliding > 0};
  }
  return {table.maps.size(), table.uses_texture, table.uses_dynamic};
}

// Copies the masks of a part. Their slots stay valid because the part is a prefix of the table.
PartMasks MasksOf(const WrinkleTable& table, WrinklePart part) {
  PartMasks masks;
  const auto num_maps = static_cast<std::int32_t>(NeedsOf(table, part).num_maps);
  for (std::size_t subject = 0; subject + 1 < table.first_masks.size(); ++subject) {
    masks.first.push_back(static_cast<std::uint32_t>(masks.masks.size()));
    for (std::uint32_t i = table.first_masks[subject]; i < table.first_masks[subject + 1]; ++i) {
      if (table.dynamic_masks[i].slot < num_maps) masks.masks.push_back(table.dynamic_masks[i]);
    }
  }
  masks.first.push_back(static_cast<std::uint32_t>(masks.masks.size()));
  return masks;
}

int PaddedMaps(std::size_t active, int num_maps) {
  if (active == 0) return 0;
  return std::min(static_cast<int>(std::bit_ceil(active)), 4 * MapSlots(num_maps));
}

std::vector<std::uint8_t> WrinkleBlock(const WrinkleTable& table, WrinklePart part, int num_maps,
                                       const WrinkleLayout& layout) {
  std::vector<std::uint8_t> block(WrinkleBlockSize(num_maps, layout.num_mask_layers));
  const std::size_t count = NeedsOf(table, part).num_maps;
  if (count == 0) return block;
  const std::size_t weights = 4 * MapSlots(num_maps) * sizeof(ActiveMap);
  const auto layers = static_cast<std::size_t>(layout.num_mask_layers);
  std::memcpy(block.data(), table.maps.data(), count * sizeof(ActiveMap));
  std::memcpy(&block[weights], table.mask_weights.data(), count * layers * sizeof(glm::vec4));
  return block;
}

std::vector<glm::vec4> SubjectWeights(const WrinkleTable& table, int num_maps,
                                      const WrinkleLayout& layout) {
  const auto layers = static_cast<std::size_t>(layout.num_mask_layers);
  const std::size_t row = table.maps.size() * layers;
  const std::size_t padded = 4 * static_cast<std::size_t>(MapSlots(num_maps)) * layers;
  const std::size_t subjects = table.first_masks.size() - 1;
  std::vector<glm::vec4> weights(subjects * padded, glm::vec4(0.0f));
  for (std::size_t subject = 0; subject < subjects; ++subject) {
    std::copy_n(table.mask_weights.data() + subject * row, row, weights.data() + subject * padded);
  }
  return weights;
}

WrinkleGroup GroupOf(const character::Character& character, const Material& material) {
  if (!material.wrinkles) return WrinkleGroup::kNone;
  switch (material.kind) {
    case Material::Kind::kSkin: return WrinkleGroup::kSkin;
    case Material::Kind::kCloth: return WrinkleGroup::kCloth;
    case Material::Kind::kEye:
    case Material::Kind::kHair:
    case Material::Kind::kShade: return WrinkleGroup::kNone;
    case Material::Kind::kOther: break;
  }
  return Has(character, Material::Kind::kSkin) ? WrinkleGroup::kNone : WrinkleGroup::kSkin;
}

bool IsDrawnOn(const character::Character& character, const wrinkle::WrinkleMap& map,
               WrinkleGroup group) {
  using Surface = wrinkle::WrinkleMap::Surface;
  switch (group) {
    case WrinkleGroup::kSkin:
      return map.surface != Surface::kCloth || !Has(character, Material::Kind::kCloth);
    case WrinkleGroup::kCloth: return map.surface != Surface::kSkin;
    case WrinkleGroup::kNone: break;
  }
  return false;
}

void WrinkleTables::NameMap::Match(std::span<const std::string> from,
                                   std::span<const std::string> to) {
  // Names rarely change from frame to frame, so the comparison is usually all the work.
  if (!source_index.empty() && std::equal(from.begin(), from.end(), source.begin(), source.end())) {
    return;
  }
  source.assign(from.begin(), from.end());
  source_index.clear();
  for (const std::string& name : to) {
    const auto found = std::find(from.begin(), from.end(), name);
    source_index.push_back(found == from.end() ? -1 : static_cast<int>(found - from.begin()));
  }
}

void WrinkleTables::NameMap::Carry(std::span<const float> from, std::span<float> to) const {
  for (std::size_t i = 0; i < to.size(); ++i) {
    to[i] = source_index[i] < 0 ? 0.0f : from[static_cast<std::size_t>(source_index[i])];
  }
}

Result<std::unique_ptr<WrinkleTables>> WrinkleTables::Create(const character::Character& character,
                                                             WrinkleLayout layout) {
  // Missing joints are reported where the rig is solved. Here their masks stay empty.
  const wrinkle::BindOptions options{.allow_missing = true};
  Result<wrinkle::RigBinding> binding =
      wrinkle::RigBinding::Create(character.rig, character.skeleton, {}, options);
  FURROW_RETURN_IF_ERROR(binding);
  Result<wrinkle::RigBinding> skinning = wrinkle::RigBinding::Create(
      WithSkinningMasks(character.rig), character.skeleton, {}, options);
  FURROW_RETURN_IF_ERROR(skinning);
  return std::unique_ptr<WrinkleTables>(
      new WrinkleTables(character, std::move(layout), std::move(*binding), std::move(*skinning)));
}

WrinkleTables::WrinkleTables(const character::Character& character, WrinkleLayout layout,
                             wrinkle::RigBinding binding, wrinkle::RigBinding skinning)
    : layout_(std::move(layout)), binding_(std::move(binding)), skinning_(std::move(skinning)) {
  DescribeMaps(character);
  DescribeRegions(character.rig);
  DescribePalettes(character.rig);
  weights_.resize(binding_.weight_names().size());
  values_.resize(binding_.driver_value_names().size());
}

void WrinkleTables::DescribeMaps(const character::Character& character) {
  for (const wrinkle::WrinkleMap& map : character.rig.wrinkle_maps) {
    const int index = static_cast<int>(maps_.size());
    MapInfo info;
    const bool coloured = !map.colour.empty() && character.FindRigPicture(map.colour) >= 0;
    info.entry.colour =
        glm::vec4(glm::vec3(MapColour(map.name, index)), coloured ? map.colour_scale : 1.0f);
    const int layer = layout_.map_layers[static_cast<std::size_t>(index)];
    info.entry.layer = std::max(layer, 0);
    info.entry.map = index;
    if (!layout_.height_layers.empty()) {
      info.entry.height_layer = layout_.height_layers[static_cast<std::size_t>(index)];
    }
    info.entry.amplitude = layer < 0 ? 0.0f : map.amplitude;  // without a texture there is no
                                                              // relief
    for (const WrinkleGroup group : {WrinkleGroup::kSkin, WrinkleGroup::kCloth}) {
      info.in_group[static_cast<int>(group)] = IsDrawnOn(character, map, group);
    }
    maps_.push_back(info);
  }
}

void WrinkleTables::DescribeRegions(const wrinkle::Rig& rig) {
  for (const wrinkle::Region& region : rig.regions) {
    const bool textured = region.mask.kind == wrinkle::Mask::Kind::kTexture;
    const int layer = textured ? layout_.MaskLayer(region.mask.texture) : -1;
    for (const wrinkle::Feed& feed : region.feeds) {
      // In the order of RigBinding::weight_names(), which lists the feeds of all regions.
      slots_.push_back({FindMap(rig, feed.map), layer, region.mask.channel});
    }
  }
}

void WrinkleTables::DescribePalettes(const wrinkle::Rig& rig) {
  for (std::vector<glm::vec4>& palette : palettes_) {
    palette.assign(static_cast<std::size_t>(layout_.num_mask_layers) * 4, glm::vec4(0.0f));
  }
  float turn = 0.0f;
  for (const wrinkle::Region& region : rig.regions) {
    if (region.mask.kind != wrinkle::Mask::Kind::kTexture) continue;
    const int place = layout_.MaskLayer(region.mask.texture) * 4 + region.mask.channel;
    const glm::vec4 colour = Hue(turn);
    // Steps by the golden ratio give neighbouring regions of the rig different hues.
    turn = std::fmod(turn + 0.61803399f, 1.0f);
    for (const wrinkle::Feed& feed : region.feeds) {
      const int map = FindMap(rig, feed.map);
      for (int group = 0; group < kNumWrinkleGroups && map >= 0 && place >= 0; ++group) {
        if (maps_[static_cast<std::size_t>(map)].in_group[group]) {
          palettes_[group][static_cast<std::size_t>(place)] = colour;
          mask_bits_[group] |= 1u << std::min(place / 4, 31);
        }
      }
    }
  }
}

std::vector<WrinkleTables::Painted> WrinkleTables::painted(WrinkleGroup group) const {
  std::vector<Painted> painted;
  if (group == WrinkleGroup::kNone) return painted;
  for (const WeightSlot& slot : slots_) {
    if (slot.map < 0 || slot.mask_layer < 0) continue;
    if (!maps_[static_cast<std::size_t>(slot.map)].in_group[static_cast<int>(group)]) continue;
    painted.push_back({slot.map, 4 * slot.mask_layer + slot.channel});
  }
  return painted;
}

bool WrinkleTables::IsDisplaced(WrinkleGroup group, const Settings& settings) const {
  return settings.displacement.enabled && settings.displacement.strength > 0.0f &&
         group != WrinkleGroup::kNone && table(group).has_heights;
}

std::vector<SkinnedShare> WrinkleTables::skinned(WrinkleGroup group) const {
  std::vector<SkinnedShare> shares;
  if (group == WrinkleGroup::kNone) return shares;
  for (const SkinnedShare& share : dynamic_.Shares(mask_mode_)) {
    if (maps_[static_cast<std::size_t>(share.mask.map)].in_group[static_cast<int>(group)]) {
      shares.push_back(share);
    }
  }
  return shares;
}

Status WrinkleTables::CarryValues(const NamedSubject& named) {
  const PosedSubject& subject = *named.subject;
  const auto weight_names = subject.binding->weight_names();
  const auto value_names = subject.binding->driver_value_names();
  if (subject.wrinkle_weights.size() < weight_names.size()) {
    return {StatusCode::kInvalidArgument, "has fewer values than the binding has weights",
            named.field + "wrinkle_weights"};
  }
  if (subject.filtered_values.size() < value_names.size()) {
    return {StatusCode::kInvalidArgument, "has fewer values than the binding has driver values",
            named.field + "filtered_values"};
  }
  weight_map_.Match(weight_names, binding_.weight_names());
  value_map_.Match(value_names, binding_.driver_value_names());
  weight_map_.Carry(subject.wrinkle_weights, weights_);
  value_map_.Carry(subject.filtered_values, values_);
  return {};
}

Status WrinkleTables::Update(const FrameRequest& request) {
  const Settings& settings = request.settings;
  mask_mode_ = settings.view == View::kMaskDynamic ? MaskMode::kDynamic : settings.mask_mode;
  subjects_.clear();
  influences_.clear();
  for (const NamedSubject& named : SubjectsOf(request)) {
    std::fill(weights_.begin(), weights_.end(), 0.0f);
    std::fill(values_.begin(), values_.end(), 0.0f);
    if (named.subject->binding != nullptr && settings.wrinkles) {
      FURROW_RETURN_IF_ERROR(CarryValues(named));
    }
    AddSubject(mask_mode_);
  }
  FindSources();
  for (int group = 0; group < kNumWrinkleGroups; ++group) {
    FillTable(group, settings.wrinkle_strength);
  }
  return {};
}

// Adds the weights of one subject to a row of mask layers per map: regions that share a map add up
// where their masks overlap.
void WrinkleTables::AddSubject(MaskMode mode) {
  SubjectWrinkles& subject = subjects_.emplace_back();
  const auto layers = static_cast<std::size_t>(layout_.num_mask_layers);
  subject.rows.assign(maps_.size() * layers, glm::vec4(0.0f));
  subject.textured.assign(maps_.size(), false);
  for (std::size_t i = 0; i < slots_.size() && mode != MaskMode::kDynamic; ++i) {
    const WeightSlot& slot = slots_[i];
    if (slot.map < 0 || slot.mask_layer < 0 || !(weights_[i] > 0.0f)) continue;
    const auto map = static_cast<std::size_t>(slot.map);
    subject.rows[map * layers + static_cast<std::size_t>(slot.mask_layer)][slot.channel] +=
        weights_[i];
    subject.textured[map] = true;
  }
  dynamic_.Update(mode, values_, weights_);
  for (int map = 0; map < num_maps(); ++map) dynamic_.Append(map, &subject.masks);
  influences_.insert(influences_.end(), dynamic_.influences().begin(), dynamic_.influences().end());
}

bool WrinkleTables::IsTextured(std::size_t map) const {
  return std::ranges::any_of(
      subjects_, [&](const SubjectWrinkles& subject) { return bool(subject.textured[map]); });
}

// The order of Source decides: a map with several kinds of masks belongs to the kind that is
// hardest to compose.
void WrinkleTables::FindSources() {
  sources_.assign(maps_.size(), Source::kPainted);
  for (const SubjectWrinkles& subject : subjects_) {
    for (const DynamicMaskBlock& mask : subject.masks) {
      Source& source = sources_[static_cast<std::size_t>(mask.slot)];
      source = std::min(source, mask.column < 0 ? Source::kSliding : Source::kSkinned);
    }
  }
}

// Appends the active maps of one source. `slots`: the position of each map of the rig in the list;
// -1: not listed.
void WrinkleTables::ListMaps(int group, float strength, Source source, std::vector<int>* slots) {
  WrinkleTable& table = tables_[group];
  for (std::size_t map = 0; map < maps_.size(); ++map) {
    const bool textured = IsTextured(map);
    if (!maps_[map].in_group[group] || sources_[map] != source) continue;
    if (!textured && source == Source::kPainted) continue;
    (*slots)[map] = static_cast<int>(table.maps.size());
    ActiveMap entry = maps_[map].entry;
    entry.amplitude *= strength;
    table.maps.push_back(entry);
    table.has_heights = table.has_heights || entry.height_layer >= 0;
    table.uses_texture = table.uses_texture || textured;
  }
}

// Lists sliding maps first, then skinned and painted ones, so that the part that fragments must
// evaluate is a prefix (NeedsOf()).
void WrinkleTables::FillTable(int group, float strength) {
  WrinkleTable& table = tables_[group];
  table = {};
  std::vector<int> slots(maps_.size(), -1);
  ListMaps(group, strength, Source::kSliding, &slots);
  table.num_sliding = table.maps.size();
  table.paints_sliding = table.uses_texture;
  ListMaps(group, strength, Source::kSkinned, &slots);
  table.num_dynamic = table.maps.size();
  table.uses_dynamic = table.num_dynamic > 0;
  table.paints_dynamic = table.uses_texture;
  ListMaps(group, strength, Source::kPainted, &slots);
  const auto layers = static_cast<std::ptrdiff_t>(layout_.num_mask_layers);
  for (const SubjectWrinkles& subject : subjects_) {
    table.first_masks.push_back(static_cast<std::uint32_t>(table.dynamic_masks.size()));
    for (const ActiveMap& entry : table.maps) {
      const auto row = subject.rows.begin() + entry.map * layers;
      table.mask_weights.insert(table.mask_weights.end(), row, row + layers);
    }
    for (DynamicMaskBlock mask : subject.masks) {
      mask.slot = slots[static_cast<std::size_t>(mask.slot)];
      if (mask.slot >= 0) table.dynamic_masks.push_back(mask);
    }
  }
  table.first_masks.push_back(static_cast<std::uint32_t>(table.dynamic_masks.size()));
}

}  // namespace furrow::render
