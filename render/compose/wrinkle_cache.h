// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "render/compose/composed_material.h"
#include "render/compose/skinned_masks.h"
#include "render/scene/draw_list.h"
#include "render/scene/gpu_character.h"
#include "render/wrinkles/wrinkle_table.h"

namespace furrow::render {

// Which materials of a frame are drawn with their wrinkles composed beforehand.
//
// - A picture composes wrinkles in every fragment: all masks, and every map at work. On a surface
//   of small triangles most of that is not seen. A ComposedMaterial makes a texel once, as fine as
//   the picture shows it, and again when its weights change; the picture then looks up one texture,
//   as if there were no wrinkles.
// - A level of the texture is made from the same levels of masks and maps that a fragment of its
//   size would have looked up, so that both come to the same, interpolation of products apart.
// - So are those that skin weights mask: how much of a joint's influence a place of the surface
//   takes never changes (SkinnedMasks). Where places that differ in it share texels, as two sleeves
//   with one texture do, such maps stay in the fragment, on top; so does, in any case, a map of
//   which a mask slides: that depends on the pose.
// - Where it would not pay, a frame goes without: more texels to make than pixels to save; weights
//   that move on a device for which fragments are cheap; several subjects, each with a face of its
//   own.
class WrinkleCache {
 public:
  // All outlive it. `is_software`: a processor draws.
  WrinkleCache(const GpuCharacter* gpu, const WrinkleTables* tables,
               std::span<const glm::mat4> inverse_bind_matrices, bool is_software);

  // How the frame's one subject is looked at.
  struct View {
    const PosedSubject* subject = nullptr;
    glm::mat4 projection{1.0f};  // to clip space
    float pixels = 0.0f;         // of a metre where clip space's w is 1
    float picture = 0.0f;        // pixels in all
    const DrawList* list = nullptr;
  };
  // What the frame composes.
  void Plan(const Settings& settings, const View& view);
  // The frame composes nothing.
  void Disable();

  // What takes the place of a material's own in this frame, once composed, and what is left to
  // fragments. Without textures: nothing is composed.
  struct Composed {
    ComposedMaterial::Textures textures;
    WrinklePart rest = WrinklePart::kAll;
  };
  [[nodiscard]] Composed Find(int material) const;
  // Something that Find() gives is not up to date.
  [[nodiscard]] bool is_stale() const;
  void Compose();

 private:
  struct Entry {
    std::unique_ptr<SkinnedMasks> skinned;  // null: nobody asked yet
    std::unique_ptr<ComposedMaterial> composed;
    ComposedMaterial::Wanted wanted;  // by the last frame that was planned
    WrinklePart rest = WrinklePart::kAll;
    int num_too_fine = 0;  // pictures in a row that would do with a smaller texture
    bool is_used = false;
    bool is_stale = false;
  };
  // How a material is seen.
  struct Sight {
    float texels_per_uv = 0.0f;  // that the picture can show; 0: unseen
    float pixels = 0.0f;         // that it may cover
  };
  [[nodiscard]] Sight Look(int material, const View& view) const;
  // Those of the mode in which the tables were updated.
  [[nodiscard]] Entry& EntryOf(int material);
  [[nodiscard]] const Entry& EntryOf(int material) const;
  [[nodiscard]] std::unique_ptr<SkinnedMasks> FindSkinned(int material) const;
  [[nodiscard]] ComposeSelection SelectionOf(const GpuMaterial& material,
                                             const SkinnedMasks& skinned) const;
  [[nodiscard]] glm::ivec2 SizeFor(const GpuMaterial& material, const Sight& sight) const;
  [[nodiscard]] ComposeInk InkOf(const ComposedMaterial& composed, WrinklePart rest,
                                 const Settings& settings) const;
  // A map of the selection as the table has it in one of its slots.
  void AddMap(const ComposeSelection& selection, std::size_t map, std::size_t slot,
              ComposeInk* ink) const;
  // Which regions are seen, and from which level on.
  void LookAtRegions(int material, const ComposedMaterial& composed, const View& view,
                     ComposedMaterial::Wanted* wanted) const;
  void LookAtRegion(const MaskRegion& region, std::size_t channel, const ComposedMaterial& composed,
                    const View& view, ComposedMaterial::Wanted* wanted) const;
  // There is a texture of the right size for it; false: it would be too large.
  [[nodiscard]] bool Prepare(const GpuMaterial& material, const Sight& sight, Entry* entry) const;
  void PlanMaterial(int index, const Settings& settings, const View& view, const Sight& sight,
                    Entry* entry);

  const GpuCharacter* gpu_;
  const WrinkleTables* tables_;
  std::span<const glm::mat4> inverse_bind_matrices_;
  bool is_software_;
  std::vector<Entry> entries_;  // by material; of each, with the rig's masks and with skinned ones
};

}  // namespace furrow::render
