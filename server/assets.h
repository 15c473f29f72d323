// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "base/status.h"
#include "character/character.h"
#include "render/settings/settings.h"
#include "rig/skeleton_match.h"
#include "server/config/config.h"
#include "wrinkle/rig/rig.h"

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
