// SPDX-License-Identifier: Apache-2.0
#include "render/compose/wrinkle_cache.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

namespace furrow::render {
namespace {

constexpr int kMaxSide = 2048;  // texels
// Texels that can be painted in the time that the fragments of one pixel take to evaluate wrinkles.
constexpr float kTexelsPerPixel = 8.0f;
// A level that would contribute at most this share to a pixel is left without wrinkles. The pixel
// is nearer to the next coarser level.
constexpr float kIgnoredShare = 0.25f;
// A texture that is finer than necessary by this many levels is replaced after this many pictures
// in a row. A moving camera, or two viewers at different distances, therefore do not cause repeated
// repainting.
constexpr float kMaxExcessLevels = 1.25f;
constexpr int kExcessPictures = 250;

}  // namespace

WrinkleCache::WrinkleCache(const GpuCharacter* gpu, const WrinkleTables* tables,
                           std::span<const glm::mat4> inverse_bind_matrices, bool is_software)
    : gpu_(gpu),
      tables_(tables),
      inverse_bind_matrices_(inverse_bind_matrices),
      is_software_(is_software),
      entries_(2 * static_cast<std::size_t>(gpu->num_materials())) {}

void WrinkleCache::Disable() {
  for (Entry& entry : entries_) entry.is_used = entry.is_stale = false;
}

// Materials drop out for cheap reasons first. The comparison of texels and pixels comes last.
void WrinkleCache::Plan(const Settings& settings, const View& view) {
  Disable();
  for (int index = 0; index < gpu_->num_materials(); ++index) {
    const GpuMaterial& material = gpu_->material(index);
    if (material.group == WrinkleGroup::kNone) continue;
    // Its texels and those of the wrinkle maps are different places.
    if (material.own_texture_uvs) continue;
    // Cut-outs need the alpha of the base colour, which leaves no room for the cavity.
    if (material.alpha_test && gpu_->wrinkle_looks() != 0) continue;
    if (tables_->IsDisplaced(material.group, settings)) continue;
    const WrinkleTable& table = tables_->table(material.group);
    if (table.maps.empty()) continue;
    const Sight sight = Look(index, view);
    if (!(sight.texels_per_uv > 0.0f)) continue;
    Entry& entry = EntryOf(index);
    if (entry.skinned == nullptr) entry.skinned = FindSkinned(index);
    entry.rest = entry.skinned->is_unique() ? WrinklePart::kSliding : WrinklePart::kDynamic;
    if (NeedsOf(table, entry.rest).num_maps == table.maps.size()) continue;
    PlanMaterial(index, settings, view, sight, &entry);
  }
}

// The two mask modes have different skinned masks, so each has its own entry and textures.
const WrinkleCache::Entry& WrinkleCache::EntryOf(int material) const {
  const bool is_dynamic = tables_->mask_mode() == MaskMode::kDynamic;
  return entries_[2 * static_cast<std::size_t>(material) + (is_dynamic ? 1 : 0)];
}

WrinkleCache::Entry& WrinkleCache::EntryOf(int material) {
  return const_cast<Entry&>(std::as_const(*this).EntryOf(material));
}

// Needs the meshes' skin weights, which are only on the GPU. The result is computed once per
// material.
std::unique_ptr<SkinnedMasks> WrinkleCache::FindSkinned(int material) const {
  const std::vector<SkinnedShare> shares = tables_->skinned(gpu_->material(material).group);
  std::vector<character::Mesh> meshes;
  for (const GpuMesh& mesh : gpu_->meshes()) {
    if (mesh.material == material && !shares.empty()) meshes.push_back(ReadMesh(mesh));
  }
  return std::make_unique<SkinnedMasks>(meshes, shares, inverse_bind_matrices_, material);
}

// The finest resolution that any mesh of the material needs, and an estimate of the pixels that it
// covers, including hidden ones.
WrinkleCache::Sight WrinkleCache::Look(int material, const View& view) const {
  Sight sight;
  for (std::size_t index = 0; index < gpu_->meshes().size(); ++index) {
    const GpuMesh& mesh = gpu_->meshes()[index];
    if (mesh.material != material || !(mesh.uv_per_metre > 0.0f)) continue;
    const DrawList::Sight& seen = view.list->sight(index);
    sight.texels_per_uv = std::max(sight.texels_per_uv, seen.pixels / mesh.uv_per_metre);
    // A convex body shows about a quarter of its surface from any side.
    const float shown = 0.25f * mesh.surface * seen.pixels * seen.pixels;
    sight.pixels += std::min(seen.covered * view.picture, shown);
  }
  return sight;
}

void WrinkleCache::FindVisibleRegions(int material, const ComposedMaterial& composed,
                                      const View& view, ComposedMaterial::Needs* needs) const {
  const ComposeSelection& selection = composed.selection();
  const std::vector<int>& channels = selection.channels;
  needs->is_seen.assign(selection.num_channels(), false);
  needs->first_levels.assign(selection.num_channels(), composed.num_levels() - 1);
  // Regions of painted masks. Invisible ones need not be painted.
  for (const MaskRegion& region : gpu_->mask_regions()) {
    const auto channel = std::ranges::find(channels, region.channel);
    if (region.material != material || channel == channels.end()) continue;
    AddVisibleRegion(region, static_cast<std::size_t>(channel - channels.begin()), composed, view,
                     needs);
  }
  if (selection.skinned == nullptr) return;
  for (const MaskRegion& region : selection.skinned->regions()) {
    AddVisibleRegion(region, channels.size() + static_cast<std::size_t>(region.channel), composed,
                     view, needs);
  }
}

void WrinkleCache::AddVisibleRegion(const MaskRegion& region, std::size_t channel,
                                    const ComposedMaterial& composed, const View& view,
                                    ComposedMaterial::Needs* needs) const {
  const PosedSubject& subject = *view.subject;
  const JointBounds::Extent extent =
      region.bounds.Look({subject.model, {}}, view.projection * subject.placement, view.reach);
  if (!extent.is_seen()) return;
  needs->is_seen[channel] = true;
  // The columns of a placement have the length of its scale. Bounds and UV densities are in the
  // character's own metres.
  const float pixels = view.pixels * glm::length(glm::vec3(subject.placement[0]));
  const auto side = static_cast<float>(std::max(composed.size().x, composed.size().y));
  // log2 of texels per pixel where the region is nearest and most stretched.
  const float level =
      extent.nearest > 0.0f
          ? std::log2(side * std::max(region.uv_per_metre, 1e-6f) * extent.nearest / pixels)
          : 0.0f;
  int& first = needs->first_levels[channel];
  first = static_cast<int>(std::clamp(level + kIgnoredShare, 0.0f, static_cast<float>(first)));
}

void WrinkleCache::PlanMaterial(int index, const Settings& settings, const View& view,
                                const Sight& sight, Entry* entry) {
  if (!Prepare(gpu_->material(index), sight, entry)) return;
  // Decide in this order: the textures are already right; the weights are held, so painting pays
  // over time; or painting is cheaper than evaluating fragments.
  ComposedMaterial& composed = *entry->composed;
  ComposedMaterial::Needs needs{StrengthsOf(composed, entry->rest, settings), {}, {}};
  FindVisibleRegions(index, composed, view, &needs);
  const bool is_painted = composed.IsPainted(needs);
  const bool is_held = entry->needs.strengths.weights.size() == needs.strengths.weights.size() &&
                       composed.IsSame(entry->needs.strengths, needs);
  const auto texels = static_cast<float>(composed.NumStale(needs));
  const bool pays = is_software_ && texels <= kTexelsPerPixel * sight.pixels;
  entry->is_used = is_painted || is_held || pays;
  entry->is_stale = entry->is_used && !is_painted;
  entry->needs = std::move(needs);
}

// Creates or keeps the textures. Returns false if the material should be drawn without them.
bool WrinkleCache::Prepare(const GpuMaterial& material, const Sight& sight, Entry* entry) const {
  const glm::ivec2 size = SizeFor(material, sight);
  // Limits memory and painting time.
  if (std::max(size.x, size.y) > kMaxSide) return false;
  if (entry->composed != nullptr) {
    const float finer =
        std::log2(static_cast<float>(entry->composed->size().x) / static_cast<float>(size.x));
    entry->num_too_fine = finer < kMaxExcessLevels ? 0 : entry->num_too_fine + 1;
    // Too coarse a texture is replaced at once, because the loss of detail would be visible.
    if (finer >= 0.0f && entry->num_too_fine < kExcessPictures) return true;
  }
  entry->num_too_fine = 0;
  entry->needs = {};
  entry->composed =
      std::make_unique<ComposedMaterial>(*gpu_, SelectionOf(material, *entry->skinned), size);
  return true;
}

// The finest of the input sizes, halved while the picture cannot show the difference.
glm::ivec2 WrinkleCache::SizeFor(const GpuMaterial& material, const Sight& sight) const {
  const glm::ivec2 finest = glm::max(
      glm::max(TextureSize(material.derivatives), TextureSize(gpu_->wrinkle_derivatives())),
      gpu_->wrinkle_looks() == 0 ? glm::ivec2(0) : TextureSize(material.base_colour));
  const float side = static_cast<float>(std::max(finest.x, finest.y));
  const float level = std::clamp(std::log2(side / sight.texels_per_uv), 0.0f, 16.0f);
  return glm::max(finest / (1 << static_cast<int>(level)), glm::ivec2(1));
}

ComposeSelection WrinkleCache::SelectionOf(const GpuMaterial& material,
                                           const SkinnedMasks& skinned) const {
  ComposeSelection selection;
  selection.material = &material;
  const auto add = [](int item, std::vector<int>* list) {
    const auto place = std::ranges::lower_bound(*list, item);
    if (place == list->end() || *place != item) list->insert(place, item);
  };
  // Lists stay sorted and without duplicates, as ComposeSelection requires.
  for (const WrinkleTables::Painted& painted : tables_->painted(material.group)) {
    add(painted.map, &selection.maps);
    add(painted.channel, &selection.channels);
  }
  if (!skinned.is_unique()) return selection;
  selection.skinned = &skinned;
  for (const SkinnedShare& share : skinned.channels()) add(share.mask.map, &selection.maps);
  return selection;
}

ComposeStrengths WrinkleCache::StrengthsOf(const ComposedMaterial& composed, WrinklePart rest,
                                           const Settings& settings) const {
  const ComposeSelection& selection = composed.selection();
  const WrinkleTable& table = tables_->table(selection.material->group);
  const std::size_t maps = selection.maps.size();
  ComposeStrengths strengths{std::vector<float>(selection.num_channels() * maps, 0.0f),
                             std::vector<float>(maps, 1.0f),
                             std::vector<float>(maps, 1.0f),
                             {settings.wrinkle_maps.blood_flow, settings.wrinkle_maps.cavity}};
  // Maps before NeedsOf() stay in the fragment shader.
  for (std::size_t slot = NeedsOf(table, rest).num_maps; slot < table.maps.size(); ++slot) {
    const auto found = std::ranges::find(selection.maps, table.maps[slot].map);
    if (found == selection.maps.end()) continue;
    AddMap(selection, static_cast<std::size_t>(found - selection.maps.begin()), slot, &strengths);
  }
  return strengths;
}

void WrinkleCache::AddMap(const ComposeSelection& selection, std::size_t map, std::size_t slot,
                          ComposeStrengths* strengths) const {
  const WrinkleTable& table = tables_->table(selection.material->group);
  const auto layers = static_cast<std::size_t>(gpu_->layout().num_mask_layers);
  const std::size_t maps = selection.maps.size();
  strengths->amplitudes[map] = table.maps[slot].amplitude;
  strengths->scales[map] = table.maps[slot].colour.a;
  std::size_t mask = 0;
  for (const int channel : selection.channels) {
    const glm::vec4& row =
        table.mask_weights[slot * layers + static_cast<std::size_t>(channel / 4)];
    strengths->weights[mask++ * maps + map] = row[channel % 4];
  }
  if (selection.skinned == nullptr) return;
  for (const SkinnedShare& share : selection.skinned->channels()) {
    if (share.mask.map == selection.maps[map]) {
      strengths->weights[mask * maps + map] = tables_->influence(share.joint, share.column);
    }
    ++mask;
  }
}

WrinkleCache::Composed WrinkleCache::Find(int material) const {
  const Entry& entry = EntryOf(material);
  if (!entry.is_used) return {};
  return {entry.composed->textures(), entry.rest};
}

bool WrinkleCache::is_stale() const { return std::ranges::any_of(entries_, &Entry::is_stale); }

void WrinkleCache::Compose() {
  for (Entry& entry : entries_) {
    if (entry.is_stale) entry.composed->Paint(entry.needs);
    entry.is_stale = false;
  }
}

}  // namespace furrow::render
