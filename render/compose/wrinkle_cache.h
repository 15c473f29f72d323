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

// Decides which materials of a frame are drawn with wrinkles composed into their textures.
//
// - Without the cache, every fragment evaluates all masks and all active maps. On surfaces of small
//   triangles most of those fragments are never visible. A ComposedMaterial computes each texel
//   once, at the resolution that the picture shows, and again when its weights change. The picture
//   then samples one texture, as if there were no wrinkles.
// - A level of the composed texture uses the same levels of masks and maps that a fragment of its
//   size would sample. The results agree, except for the interpolation of products.
// - Masks by skin weight are composed too, because the share that a point of the surface takes of a
//   joint's influence is constant (SkinnedMasks). If points with different shares use the same
//   texel, their maps stay in the fragment shader. So do maps with a sliding mask, which depends on
//   the pose.
// - The cache is not used where it would not pay: when more texels would be painted than pixels
//   saved, when weights move on a device with cheap fragments, and when there are several subjects,
//   each with its own face.
class WrinkleCache {
 public:
  // All arguments must outlive the cache. `is_software`: the driver renders on the CPU.
  WrinkleCache(const GpuCharacter* gpu, const WrinkleTables* tables,
               std::span<const glm::mat4> inverse_bind_matrices, bool is_software);

  // How the camera sees the frame's only subject.
  struct View {
    const PosedSubject* subject = nullptr;  // required, like `list`
    glm::mat4 projection{1.0f};             // model space to clip space
    float pixels = 0.0f;                    // pixels per metre where clip space's w is 1
    float reach = 0.0f;                     // longest way of a vertex by morph targets, metres
    float picture = 0.0f;                   // number of pixels of the picture: width * height
    const DrawList* list = nullptr;
  };
  // Chooses what this frame composes. `view` is only used during the call.
  void Plan(const Settings& settings, const View& view);
  // Composes nothing in this frame.
  void Disable();

  // The textures that replace a material's textures in this frame, and the part of the wrinkles
  // that the fragment shader must still evaluate. textures.derivatives is 0 if nothing is composed.
  struct Composed {
    ComposedMaterial::Textures textures;
    WrinklePart rest = WrinklePart::kAll;
  };
  // `material`: index into Character::materials.
  [[nodiscard]] Composed Find(int material) const;
  // Returns true if Compose() must run before the textures that Find() returns are drawn.
  [[nodiscard]] bool is_stale() const;
  // Paints what Plan() chose. Needs a current context.
  void Compose();

 private:
  struct Entry {
    std::unique_ptr<SkinnedMasks> skinned;  // null: not computed yet
    std::unique_ptr<ComposedMaterial> composed;
    ComposedMaterial::Needs needs;  // of the last planned frame
    WrinklePart rest = WrinklePart::kAll;
    int num_too_fine = 0;  // consecutive pictures for which a smaller texture would do
    bool is_used = false;
    bool is_stale = false;
  };
  // Apparent size of a material.
  struct Sight {
    float texels_per_uv = 0.0f;  // resolution that the picture can show; 0: invisible
    float pixels = 0.0f;         // upper bound of the pixels that it covers
  };
  [[nodiscard]] Sight Look(int material, const View& view) const;
  // The entry for the mask mode of the last WrinkleTables::Update().
  [[nodiscard]] Entry& EntryOf(int material);
  [[nodiscard]] const Entry& EntryOf(int material) const;
  [[nodiscard]] std::unique_ptr<SkinnedMasks> FindSkinned(int material) const;
  [[nodiscard]] ComposeSelection SelectionOf(const GpuMaterial& material,
                                             const SkinnedMasks& skinned) const;
  [[nodiscard]] glm::ivec2 SizeFor(const GpuMaterial& material, const Sight& sight) const;
  [[nodiscard]] ComposeStrengths StrengthsOf(const ComposedMaterial& composed, WrinklePart rest,
                                             const Settings& settings) const;
  // Adds a map of the selection, which the table lists at `slot`.
  void AddMap(const ComposeSelection& selection, std::size_t map, std::size_t slot,
              ComposeStrengths* strengths) const;
  // Finds the visible regions and the finest level that each needs.
  void FindVisibleRegions(int material, const ComposedMaterial& composed, const View& view,
                          ComposedMaterial::Needs* needs) const;
  void AddVisibleRegion(const MaskRegion& region, std::size_t channel,
                        const ComposedMaterial& composed, const View& view,
                        ComposedMaterial::Needs* needs) const;
  // Ensures a composed texture of the right size. False: it would be too large.
  [[nodiscard]] bool Prepare(const GpuMaterial& material, const Sight& sight, Entry* entry) const;
  void PlanMaterial(int index, const Settings& settings, const View& view, const Sight& sight,
                    Entry* entry);

  const GpuCharacter* gpu_;
  const WrinkleTables* tables_;
  std::span<const glm::mat4> inverse_bind_matrices_;
  bool is_software_;
  std::vector<Entry> entries_;  // two per material: with the rig's masks, and with skinning masks
};

}  // namespace furrow::render
