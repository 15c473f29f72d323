// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/status.h"
#include "character/character.h"

namespace furrow::authoring {

// What of a character an export contains, and under which names. Everything refers to the character
// by index.
struct ExportPlan {
  struct Map {
    int map = 0;       // index into Rig::wrinkle_maps
    std::string name;  // of its files: letters, digits and underscores, unique
    // Indices into Character::pictures; -1: none. The relief is a normal or a derivative map.
    int normal = -1;
    int derivative = -1;
    int height = -1;
    int colour = -1;
    int cavity = -1;
    [[nodiscard]] bool has_relief() const { return normal >= 0 || derivative >= 0; }
  };
  // One RGBA picture with the masks of up to four regions.
  struct Mask {
    // Per channel: index into Rig::regions, the first of those that share it; -1: none.
    std::array<int, 4> regions{-1, -1, -1, -1};
    int width = 1;  // texels: the largest of its sources
    int height = 1;
  };
  // One wrinkle weight, in the order in which a daemon sends them (RigBinding::weight_names()).
  struct Weight {
    std::string name;  // "brow_l.squash"
    int region = 0;    // index into Rig::regions
    int feed = 0;      // index into Region::feeds
    int map = -1;      // index into `maps`; -1: the weight is not drawn
    int mask = -1;     // index into `masks`; -1: the weight is not drawn
    int channel = 0;   // 0..3 = r, g, b, a
    // The mask follows skin weights, or slides. As in the renderer, the sum of these weights times
    // their masks is limited to 1, and of weights of one map in one channel, the largest counts.
    bool is_skinned = false;
    [[nodiscard]] bool is_drawn() const { return map >= 0 && mask >= 0; }
  };
  // A material with wrinkles.
  struct Material {
    int material = 0;  // index into Character::materials
    std::string name;  // of its files and functions: letters, digits and underscores, unique
    bool cloth = false;
    // Ascending indices into the lists below: what is drawn on the material.
    std::vector<int> maps;
    std::vector<int> masks;
    std::vector<int> weights;
  };

  std::vector<Map> maps;
  std::vector<Mask> masks;
  std::vector<Weight> weights;
  std::vector<Material> materials;
  std::vector<std::string> notes;  // what is left out or different, and why; one sentence each
};

// Plans the export of a character with a rig.
//
// - Masks are packed four to a picture, in the order of the rig's regions. Skin and cloth have
//   pictures of their own, so that a material reads as few as possible.
// - Masks by skin weights become pictures (painted_mask.h). Regions of the same joints, such as the
//   inner and the outer side of a knee, share a channel.
// - Sliding masks that stay in place become pictures, too.
// - A region has no picture if its mask slides around a ball, because it then follows the pose, or
//   if the rig's picture is missing. Its weights are listed, so that indices match the stream, but
//   not drawn.
//
// Errors: kNotFound (no rig), kUnsupported (no weight can be drawn; the text lists the reasons).
[[nodiscard]] Result<ExportPlan> PlanExport(const character::Character& character);

// The names of the regions in a channel of a mask, separated by blanks; empty: unused.
[[nodiscard]] std::string RegionsOf(const wrinkle::Rig& rig, const ExportPlan& plan, int mask,
                                    int channel);

}  // namespace furrow::authoring
