// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "gltf/animation/track.h"
#include "gltf/document/document.h"
#include "gltf/scene/nodes.h"

namespace furrow::gltf {

// What a track animates. Values per key: 3, 4 (x y z w), 3, or one per morph target.
enum class TrackTarget : std::uint8_t { kTranslation, kRotation, kScale, kMorphWeights };

struct NodeTrack {
  int node = kNone;
  TrackTarget target = TrackTarget::kTranslation;
  Track track;
};

struct Animation {
  std::string name;               // may be empty
  std::vector<NodeTrack> tracks;  // at most one per node and target
};

// An animation that a file offers.
struct AnimationSummary {
  std::string name;      // may be empty
  double seconds = 0.0;  // its latest key, as the file states it; 0 if it does not
};

// All animations of a document, in its order. Does not read any key.
[[nodiscard]] std::vector<AnimationSummary> ListAnimations(const Document& document);

// Reads one animation of a document with Contents::kAnimation. `choice`: its name, or its index
// from 0; empty: the first.
//
// - Without a choice, further animations are a warning that names them. Channels with an unknown
//   path are warnings. A channel without a node
//   is ignored, as the specification demands.
// - Output values may be floats or normalised integers. Keys of rotations may deviate from unit
//   length by a factor of 2.
//
// Errors: Accessor::Create()'s, kNotFound (no such choice), kSchema (no animation, an index out of
// range, two channels for one target, times that do not increase, a wrong number of values, an
// unknown interpolation), kLimit (kMaxChannels, kMaxAnimationNumbers), kNonFinite.
[[nodiscard]] Result<Animation> ReadAnimation(Document* document, const NodeForest& forest,
                                              std::string_view choice = {});

}  // namespace furrow::gltf
