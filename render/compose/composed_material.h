// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "render/compose/compose_job.h"
#include "render/compose/compose_reader.h"
#include "render/gl/gl_objects.h"

namespace furrow::render {

// Textures of one material with the wrinkles painted into them: the normal map (as slopes) and, if
// wrinkle maps change colours, the base colour. Both have half floats and mip levels.
//
// The CPU paints the tiles where weights have changed. It paints into two copies in turn, so that
// it never waits for a frame that is still being drawn.
class ComposedMaterial {
 public:
  // `gpu` and everything that `selection` points to must outlive this object. `size`: texels of the
  // finest level. This and the functions that paint need a current context.
  ComposedMaterial(const GpuCharacter& gpu, ComposeSelection selection, glm::ivec2 size);

  struct Textures {
    GLuint derivatives = 0;  // layout: ComposeJob::slopes
    GLuint colour = 0;       // base colour in rgb, cavity in alpha; 0: use the material's texture
  };
  [[nodiscard]] const Textures& textures() const { return copies_[front_].textures; }
  [[nodiscard]] glm::ivec2 size() const { return size_; }
  [[nodiscard]] int num_levels() const { return static_cast<int>(levels_.size()); }
  [[nodiscard]] const ComposeSelection& selection() const { return selection_; }

  // What a picture needs from the textures.
  struct Needs {
    ComposeStrengths strengths;
    // Per channel of the selection: the picture shows its region. Other channels may be outdated.
    std::vector<bool> is_seen;
    // Per channel of the selection: the finest level that the picture samples, 0 for the finest of
    // all. Meaningless for channels that are not seen.
    std::vector<int> first_levels;
  };
  // Returns true if textures() already meet the needs.
  [[nodiscard]] bool IsPainted(const Needs& needs) const;
  // The number of texels that Paint() would paint; 0 if the other copy already meets the needs.
  [[nodiscard]] std::size_t NumStale(const Needs& needs) const;
  // Paints. The first time that a level is painted, its inputs are read back from the GPU, which
  // takes milliseconds.
  void Paint(const Needs& needs);

  // Returns true if the channels that `to` shows look the same with the strengths `from` and with
  // those of `to`. Invisibly small changes of weights do not count.
  [[nodiscard]] bool IsSame(const ComposeStrengths& from, const Needs& to) const;

 private:
  struct Level {
    glm::ivec2 size{1};
    bool is_read = false;
    std::vector<ComposeTile> tiles;
  };
  struct Copy {
    gl::Texture derivatives;
    gl::Texture colour;
    Textures textures;
    ComposeStrengths strengths;     // strengths that are painted in the copy
    std::vector<int> first_levels;  // per channel: finest level that is painted
    // Per channel, one bit per level: the level may contain the channel, up to date or outdated.
    // This matters for the level before a channel's first one, of which a pixel also samples a
    // small share.
    std::vector<std::uint16_t> painted_levels;
  };
  [[nodiscard]] bool IsChanged(const ComposeStrengths& from, const ComposeStrengths& to,
                               std::size_t channel) const;
  // Per channel of the selection: it is visible and looks different.
  [[nodiscard]] std::vector<bool> Changes(const ComposeStrengths& from, const Needs& to) const;
  [[nodiscard]] const Copy& Back() const;
  [[nodiscard]] Copy MakeCopy() const;
  void FillBase(Copy* copy) const;
  void CopyFront(Copy* copy) const;
  void ReadLevel(Level* level) const;
  // The tiles of a level where one of the `changed` channels is above 0.
  [[nodiscard]] static std::vector<const ComposeTile*> Stale(const Level& level,
                                                             const std::vector<bool>& changed);
  // Returns true if a level of a copy shows an outdated state of a visible channel. `is_changed`:
  // the channel has changed on all levels.
  [[nodiscard]] static bool IsStale(const Copy& copy, const Needs& needs, bool is_changed,
                                    std::size_t channel, int level);
  [[nodiscard]] static std::vector<bool> StaleChannels(const Copy& copy, const Needs& needs,
                                                       const std::vector<bool>& changed,
                                                       std::size_t level);
  // The strengths of the copy after painting. Only visible channels that changed are repainted. The
  // state of the others stays known while settings stay the same.
  [[nodiscard]] ComposeStrengths Merged(const ComposeStrengths& painted, const Needs& needs) const;
  // The copy's strengths, without the channels that start at a coarser level.
  [[nodiscard]] ComposeStrengths StrengthsOfLevel(const Copy& copy, int level) const;
  void PaintLevel(std::size_t level, const std::vector<bool>& stale, Copy* copy);
  void PaintTiles(const Copy& copy, const ComposeStrengths& strengths, std::size_t level,
                  std::span<const ComposeTile* const> tiles);
  void PaintRun(const Copy& copy, const ComposeStrengths& strengths, std::size_t level,
                std::span<const ComposeTile* const> run);

  const GpuCharacter& gpu_;
  ComposeSelection selection_;
  glm::ivec2 size_;
  std::vector<Level> levels_;
  std::array<Copy, 2> copies_;  // the second copy is created when first needed
  std::size_t front_ = 0;
  std::vector<std::uint16_t> slopes_;  // of the run that is being painted
  std::vector<std::uint16_t> colours_;
};

}  // namespace furrow::render
