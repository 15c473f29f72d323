// SPDX-License-Identifier: Apache-2.0
#include "render/compose/composed_material.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

namespace furrow::render {
namespace {

// Smaller changes of a wrinkle weight are invisible.
constexpr float kMinChange = 1.0f / 4096.0f;
constexpr float kUnknown = -1.0f;  // weight of unknown state, which counts as changed
// Texels per side of the level that is read immediately. It gives an estimate of how much there is
// to paint on finer levels.
constexpr int kEstimateSide = 256;

// A texture with storage for all levels. Each level is painted from the masks and maps of its own
// size and never generated from the finest one, because a mean of composed products is not the
// product of the means that a fragment would sample.
gl::Texture MakeLevels(glm::ivec2 size, std::size_t levels) {
  gl::Texture texture = gl::MakeTexture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), static_cast<GLsizei>(levels), GL_RGBA16F, size.x, size.y);
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  return texture;
}

void Upload(GLuint texture, int level, glm::ivec2 first, glm::ivec2 size,
            const std::vector<std::uint16_t>& halves) {
  glTextureSubImage2D(texture, level, first.x, first.y, size.x, size.y, GL_RGBA, GL_HALF_FLOAT,
                      halves.data());
}

}  // namespace

ComposedMaterial::ComposedMaterial(const GpuCharacter& gpu, ComposeSelection selection,
                                   glm::ivec2 size)
    : gpu_(gpu), selection_(std::move(selection)), size_(size) {
  // Levels go down to a single texel, because near and far subjects share the texture.
  for (glm::ivec2 level = size; level.x > 0 || level.y > 0; level /= 2) {
    levels_.push_back({glm::max(level, glm::ivec2(1)), false, {}});
  }
  copies_[front_] = MakeCopy();
  FillBase(&copies_[front_]);
  const auto is_estimate = [](const Level& level) {
    return std::max(level.size.x, level.size.y) <= kEstimateSide;
  };
  const auto estimate = std::ranges::find_if(levels_, is_estimate);
  if (estimate != levels_.end()) ReadLevel(&*estimate);
}

ComposedMaterial::Copy ComposedMaterial::MakeCopy() const {
  Copy copy;
  copy.derivatives = MakeLevels(size_, levels_.size());
  // Without looks, no map changes the colour, and fragments keep sampling the material's own
  // texture.
  if (gpu_.wrinkle_looks() != 0) copy.colour = MakeLevels(size_, levels_.size());
  copy.textures = {copy.derivatives.name(), copy.colour.name()};
  const std::size_t maps = selection_.maps.size();
  copy.strengths = {std::vector<float>(selection_.num_channels() * maps, 0.0f),
                    std::vector<float>(maps, 1.0f), std::vector<float>(maps, 1.0f),
                    glm::vec2(1.0f)};
  copy.first_levels.assign(selection_.num_channels(), 0);
  copy.painted_levels.assign(selection_.num_channels(), 0);
  return copy;
}

// Paints the base surface without wrinkles. At rest, the composed textures replace the material's
// own without further work.
void ComposedMaterial::FillBase(Copy* copy) const {
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const glm::ivec2 size = levels_[i].size;
    const BaseTexels base = ReadBaseTexels(gpu_, *selection_.material, size);
    Upload(copy->textures.derivatives, static_cast<int>(i), {0, 0}, size, base.slopes);
    if (copy->colour)
      Upload(copy->textures.colour, static_cast<int>(i), {0, 0}, size, base.colours);
  }
}

// The second copy starts as a copy of the first, which is cheaper than painting everything again.
void ComposedMaterial::CopyFront(Copy* copy) const {
  const Copy& front = copies_[front_];
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const auto level = static_cast<GLint>(i);
    const auto one = [&](const gl::Texture& from, const gl::Texture& to) {
      if (!from) return;
      glCopyImageSubData(from.name(), GL_TEXTURE_2D, level, 0, 0, 0, to.name(), GL_TEXTURE_2D,
                         level, 0, 0, 0, levels_[i].size.x, levels_[i].size.y, 1);
    };
    one(front.derivatives, copy->derivatives);
    one(front.colour, copy->colour);
  }
  copy->strengths = front.strengths;
  copy->first_levels = front.first_levels;
  copy->painted_levels = front.painted_levels;
}

// Compares what is painted with what is needed for one mask channel. A change of amplitudes or
// colours matters only where the channel has a weight.
bool ComposedMaterial::IsChanged(const ComposeStrengths& from, const ComposeStrengths& to,
                                 std::size_t channel) const {
  const std::size_t maps = selection_.maps.size();
  for (std::size_t map = 0; map < maps; ++map) {
    const float before = from.weights[channel * maps + map];
    const float now = to.weights[channel * maps + map];
    if (std::abs(now - before) > kMinChange) return true;
    const bool is_alike = from.amplitudes[map] == to.amplitudes[map] &&
                          from.scales[map] == to.scales[map] && from.looks == to.looks;
    if (!is_alike && (before > 0.0f || now > 0.0f)) return true;
  }
  return false;
}

std::vector<bool> ComposedMaterial::Changes(const ComposeStrengths& from, const Needs& to) const {
  std::vector<bool> changed;
  for (std::size_t channel = 0; channel < selection_.num_channels(); ++channel) {
    changed.push_back(to.is_seen[channel] && IsChanged(from, to.strengths, channel));
  }
  return changed;
}

bool ComposedMaterial::IsSame(const ComposeStrengths& from, const Needs& to) const {
  const std::vector<bool> changed = Changes(from, to);
  return std::ranges::find(changed, true) == changed.end();
}

// The front copy also has to be painted down to the finest level that each visible channel needs.
bool ComposedMaterial::IsPainted(const Needs& needs) const {
  const Copy& front = copies_[front_];
  for (std::size_t i = 0; i < needs.is_seen.size(); ++i) {
    if (needs.is_seen[i] && front.first_levels[i] > needs.first_levels[i]) return false;
  }
  return IsSame(front.strengths, needs);
}

// The copy that the next Paint() changes. Until it exists, the front copy predicts how much there
// is to paint.
const ComposedMaterial::Copy& ComposedMaterial::Back() const {
  const Copy& back = copies_[1 - front_];
  return back.derivatives ? back : copies_[front_];
}

void ComposedMaterial::ReadLevel(Level* level) const {
  if (level->is_read) return;
  level->tiles = ReadComposeTiles(gpu_, selection_, level->size);
  level->is_read = true;
}

// Tiles hold only the masks that are above 0 in them, so a changed channel affects few tiles.
std::vector<const ComposeTile*> ComposedMaterial::Stale(const Level& level,
                                                        const std::vector<bool>& changed) {
  std::vector<const ComposeTile*> stale;
  for (const ComposeTile& tile : level.tiles) {
    const auto is_changed = [&](const ComposeTile::Mask& mask) { return changed[mask.channel]; };
    if (std::ranges::any_of(tile.masks, is_changed) ||
        std::ranges::any_of(tile.skinned, is_changed)) {
      stale.push_back(&tile);
    }
  }
  return stale;
}

// See the comment of Copy::painted_levels for the level before the first one.
bool ComposedMaterial::IsStale(const Copy& copy, const Needs& needs, bool is_changed,
                               std::size_t channel, int level) {
  const int first = needs.first_levels[channel];
  const bool is_old = is_changed || copy.first_levels[channel] > level;
  if (!needs.is_seen[channel] || !is_old) return false;
  return first <= level ||
         (first == level + 1 && (copy.painted_levels[channel] >> level & 1u) != 0);
}

std::vector<bool> ComposedMaterial::StaleChannels(const Copy& copy, const Needs& needs,
                                                  const std::vector<bool>& changed,
                                                  std::size_t level) {
  std::vector<bool> stale(changed.size());
  for (std::size_t i = 0; i < stale.size(); ++i) {
    stale[i] = IsStale(copy, needs, changed[i], i, static_cast<int>(level));
  }
  return stale;
}

// Counts from coarse to fine, so that unread levels can be estimated from the level that was read
// last.
std::size_t ComposedMaterial::NumStale(const Needs& needs) const {
  if (IsPainted(needs)) return 0;
  const Copy& copy = Back();
  const std::vector<bool> changed = Changes(copy.strengths, needs);
  std::size_t texels = 0;
  for (std::size_t i = levels_.size(); i-- > 0;) {
    const std::vector<bool> stale = StaleChannels(copy, needs, changed, i);
    if (std::ranges::find(stale, true) == stale.end()) continue;
    // Estimates unread levels: each has four times the texels of the next coarser one. The coarsest
    // levels hardly count.
    std::size_t read = i;
    while (read + 1 < levels_.size() && !levels_[read].is_read) ++read;
    texels += (ComposeTile::kTexels * Stale(levels_[read], stale).size()) << (2 * (read - i));
  }
  return texels;
}

// An invisible channel keeps its painted weight, so nothing needs to be repainted when it comes
// into view unchanged. If the settings changed under a painted weight, the weight no longer
// describes the texels. kUnknown then differs from every real weight, and ComposeJob paints nothing
// for it.
ComposeStrengths ComposedMaterial::Merged(const ComposeStrengths& painted,
                                          const Needs& needs) const {
  ComposeStrengths strengths = needs.strengths;
  const std::size_t maps = selection_.maps.size();
  const bool is_alike = painted.amplitudes == strengths.amplitudes &&
                        painted.scales == strengths.scales && painted.looks == strengths.looks;
  for (std::size_t i = 0; i < strengths.weights.size(); ++i) {
    const bool is_seen = needs.is_seen[i / maps];
    if (is_seen && IsChanged(painted, needs.strengths, i / maps)) continue;
    const bool is_known = is_seen || is_alike || painted.weights[i] == 0.0f;
    strengths.weights[i] = is_known ? painted.weights[i] : kUnknown;
  }
  return strengths;
}

// Channels that start at a coarser level have not been painted on this level and must stay out of
// it.
ComposeStrengths ComposedMaterial::StrengthsOfLevel(const Copy& copy, int level) const {
  ComposeStrengths strengths = copy.strengths;
  const std::size_t maps = selection_.maps.size();
  for (std::size_t i = 0; i < strengths.weights.size(); ++i) {
    if (copy.first_levels[i / maps] > level) strengths.weights[i] = 0.0f;
  }
  return strengths;
}

void ComposedMaterial::PaintLevel(std::size_t level, const std::vector<bool>& stale, Copy* copy) {
  const int number = static_cast<int>(level);
  ReadLevel(&levels_[level]);
  // Usually all channels start at or before this level, and the strengths need no copy.
  const bool is_whole = std::ranges::max(copy->first_levels) <= number;
  PaintTiles(*copy, is_whole ? copy->strengths : StrengthsOfLevel(*copy, number), level,
             Stale(levels_[level], stale));
  // Records which channels this level contains from now on.
  for (std::size_t i = 0; i < stale.size(); ++i) {
    if (!stale[i]) continue;
    const auto bit = static_cast<std::uint16_t>(1u << level);
    const bool is_painted_now = copy->first_levels[i] <= number;
    copy->painted_levels[i] =
        is_painted_now ? copy->painted_levels[i] | bit : copy->painted_levels[i] & ~bit;
  }
}

void ComposedMaterial::Paint(const Needs& needs) {
  if (IsPainted(needs)) return;
  Copy& back = copies_[1 - front_];
  if (!back.derivatives) {
    back = MakeCopy();
    CopyFront(&back);
  }
  // Determine what is stale before the back copy's state is updated.
  const std::vector<bool> changed = Changes(back.strengths, needs);
  std::vector<std::vector<bool>> stale;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    stale.push_back(StaleChannels(back, needs, changed, i));
  }
  back.strengths = Merged(back.strengths, needs);
  // A channel that did not change and needs no finer level keeps its finest painted level, so
  // moving away and back repaints nothing.
  for (std::size_t i = 0; i < changed.size(); ++i) {
    const int first = needs.first_levels[i];
    if (needs.is_seen[i] && (changed[i] || first < back.first_levels[i])) {
      back.first_levels[i] = first;
    }
  }
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    if (std::ranges::find(stale[i], true) != stale[i].end()) PaintLevel(i, stale[i], &back);
  }
  // Only now: until all levels are painted, draw calls must sample the other copy.
  front_ = 1 - front_;
}

// Uploads adjacent tiles of a row together.
void ComposedMaterial::PaintTiles(const Copy& copy, const ComposeStrengths& strengths,
                                  std::size_t level, std::span<const ComposeTile* const> tiles) {
  for (std::size_t first = 0; first < tiles.size();) {
    std::size_t count = 1;
    while (first + count < tiles.size() &&
           tiles[first + count]->place == tiles[first]->place + glm::ivec2(count, 0)) {
      ++count;
    }
    PaintRun(copy, strengths, level, tiles.subspan(first, count));
    first += count;
  }
}

void ComposedMaterial::PaintRun(const Copy& copy, const ComposeStrengths& strengths,
                                std::size_t level, std::span<const ComposeTile* const> run) {
  const std::size_t stride = ComposeTile::kSide * run.size();
  slopes_.resize(4 * stride * ComposeTile::kSide);
  colours_.resize(copy.colour ? slopes_.size() : 0);
  // The tiles of a run lie next to each other in one buffer, which needs a single upload.
  for (std::size_t i = 0; i < run.size(); ++i) {
    const std::size_t first = 4 * ComposeTile::kSide * i;
    ComposeJob job{run[i], &strengths, std::span(slopes_).subspan(first), {}, stride};
    if (copy.colour) job.colours = std::span(colours_).subspan(first);
    if (!job.Run()) return;  // cannot happen: the tile is well-formed
  }
  const auto number = static_cast<int>(level);
  const glm::ivec2 first = run.front()->place * ComposeTile::kSide;
  const glm::ivec2 size = glm::min(levels_[level].size - first,
                                   glm::ivec2(static_cast<int>(stride), ComposeTile::kSide));
  // The buffer's rows are whole tiles, but a run at the edge of the level uploads fewer texels per
  // row. The setting is global state and is reset, because all other uploads are tightly packed.
  glPixelStorei(GL_UNPACK_ROW_LENGTH, static_cast<GLint>(stride));
  Upload(copy.textures.derivatives, number, first, size, slopes_);
  if (copy.colour) Upload(copy.textures.colour, number, first, size, colours_);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
}

}  // namespace furrow::render
