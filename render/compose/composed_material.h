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

// A material's normal map, and where wrinkle maps have looks its base colour, with wrinkles in
// them. Half floats; the finest level is as large as asked for.
//
// Painted on the processor, tile by tile where weights change, and into one of two copies in turn,
// so that nothing waits for a frame that is still being drawn.
class ComposedMaterial {
 public:
  // `gpu` and what the selection points to outlive it.
  ComposedMaterial(const GpuCharacter& gpu, ComposeSelection selection, glm::ivec2 size);

  struct Textures {
    GLuint derivatives = 0;
    GLuint colour = 0;  // base colour in rgb, cavity in alpha; 0: the material's own
  };
  [[nodiscard]] const Textures& textures() const { return copies_[front_].textures; }
  [[nodiscard]] glm::ivec2 size() const { return size_; }
  [[nodiscard]] int num_levels() const { return static_cast<int>(levels_.size()); }
  [[nodiscard]] const ComposeSelection& selection() const { return selection_; }

  // What a picture needs of it.
  struct Wanted {
    ComposeInk ink;
    // A channel of the selection each; what is not seen may look otherwise.
    std::vector<bool> is_seen;
    std::vector<int> first_levels;  // the finest that is looked up where the channel is seen
  };
  // Whether textures() are that already.
  [[nodiscard]] bool IsPainted(const Wanted& wanted) const;
  // How many texels Paint() would make: none where the other copy is that.
  [[nodiscard]] std::size_t NumStale(const Wanted& wanted) const;
  // The first time that a level is painted, all that goes into it is read back from the GPU, which
  // takes milliseconds.
  void Paint(const Wanted& wanted);

  // Whether what is seen looks the same with one ink and the other. A weight that moves by less
  // than what is seen does not count.
  [[nodiscard]] bool IsSame(const ComposeInk& from, const Wanted& to) const;

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
    ComposeInk ink;                 // what is in it,
    std::vector<int> first_levels;  // of each channel from this level on.
    // Of each channel, by bits, the levels that may hold it at all, as it is or as it was. The
    // level before its first one does not: a pixel takes a little of that one, too.
    std::vector<std::uint16_t> inked_levels;
  };
  [[nodiscard]] bool IsChanged(const ComposeInk& from, const ComposeInk& to,
                               std::size_t channel) const;
  // Of the selection's channels: those that are seen and look otherwise.
  [[nodiscard]] std::vector<bool> Changes(const ComposeInk& from, const Wanted& to) const;
  [[nodiscard]] const Copy& Back() const;
  [[nodiscard]] Copy MakeCopy() const;
  void FillBare(Copy* copy) const;
  void CopyFront(Copy* copy) const;
  void ReadLevel(Level* level) const;
  // Of a level, those that a channel of `changed` reaches.
  [[nodiscard]] static std::vector<const ComposeTile*> Stale(const Level& level,
                                                             const std::vector<bool>& changed);
  // Of a level of a copy: whether a channel is seen there and out of date, or was left there as it
  // looked before. `changed`: on all levels.
  [[nodiscard]] static bool IsStale(const Copy& copy, const Wanted& wanted, bool is_changed,
                                    std::size_t channel, int level);
  [[nodiscard]] static std::vector<bool> StaleChannels(const Copy& copy, const Wanted& wanted,
                                                       const std::vector<bool>& changed,
                                                       std::size_t level);
  // What is painted over `painted`: only what is seen, and changed, is painted anew. Of the rest it
  // is known how it looks as long as settings stay.
  [[nodiscard]] ComposeInk Merged(const ComposeInk& painted, const Wanted& wanted) const;
  // The copy's, without the channels that begin on a coarser level.
  [[nodiscard]] ComposeInk InkOfLevel(const Copy& copy, int level) const;
  void PaintLevel(std::size_t level, const std::vector<bool>& stale, Copy* copy);
  void PaintTiles(const Copy& copy, const ComposeInk& ink, std::size_t level,
                  std::span<const ComposeTile* const> tiles);
  void PaintRun(const Copy& copy, const ComposeInk& ink, std::size_t level,
                std::span<const ComposeTile* const> run);

  const GpuCharacter& gpu_;
  ComposeSelection selection_;
  glm::ivec2 size_;
  std::vector<Level> levels_;
  std::array<Copy, 2> copies_;  // the second is made when first needed
  std::size_t front_ = 0;
  std::vector<std::uint16_t> slopes_;  // of the run that is being painted
  std::vector<std::uint16_t> colours_;
};

}  // namespace furrow::render
