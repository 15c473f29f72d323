// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "character/character.h"
#include "character/skeleton_match.h"
#include "render/settings.h"
#include "server/config.h"
#include "wrinkle/rig.h"
#include "wrinkle/status.h"

namespace furrow::server {

// What the daemon evaluates, and what it draws.
struct Assets {
  std::shared_ptr<const wrinkle::Rig> rig;
  std::shared_ptr<const character::Character> character;  // null: weights only
  character::SkeletonMatcher skeletons;
  render::Settings settings;  // of pictures that do not say otherwise
};

// Loads what `config` names, or the default character; where nothing is drawn its rig alone, as far
// as it has one. Errors: those of LoadCharacter() and
// LoadRig(), of render::LoadSettings(), and of SkeletonMatcher::Create() where a skeleton map is
// asked for (without the maps that ship, joints go by equal names, with a warning); kNotFound where
// there is no default character (says how to come by one).
[[nodiscard]] Result<Assets> LoadAssets(const Config& config);

}  // namespace furrow::server
