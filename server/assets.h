// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/status.h"
#include "character/character.h"
#include "render/settings/settings.h"
#include "rig/shapes/shape_match.h"
#include "rig/skeleton_match.h"
#include "server/config/config.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/shapes/joint_shapes.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::server {

// What weights need of a character with shapes, which a stream's joints may move.
struct CharacterShapes {
  wrinkle::Skeleton skeleton;
  std::vector<std::string> names;  // of the shapes
  wrinkle::MovedSurface surface;
};

// The contents of the files that a daemon works with.
struct Assets {
  std::shared_ptr<const wrinkle::Rig> rig;
  std::shared_ptr<const character::Character> character;  // null: weights only
  // The character for browsers, "<stem>.web.glb" beside it, with the rig in it. Empty: there is
  // none, it was made of another version of the character, or the daemon uses another rig.
  std::filesystem::path web_package;
  std::shared_ptr<const CharacterShapes> shapes;  // null: joints move no shapes
  // Finds the rig's joints by other names. It knows the roles that the character's package states.
  rig::SkeletonMatcher skeletons;
  rig::ShapeMatcher shape_matcher;  // finds its blend shapes by other names
  render::Settings settings;        // defaults for all pictures
};

// Loads the files that `config` names, or the default character. Loads a rig and no character if
// `config` names only a rig, or if rendering is off and there is a rig that reads no blend shapes.
// If the shipped skeleton maps are missing, logs a warning, and joints are then matched by equal
// names only; likewise for shape maps and blend shapes.
//
// Errors: those of LoadCharacter(), LoadRig() and render::LoadSettings(), and of
// SkeletonMatcher::Create() and ShapeMatcher::Create() if `config` names a map; kNotFound without a
// default character, with a hint how to get one.
[[nodiscard]] Result<Assets> LoadAssets(const Config& config);

}  // namespace furrow::server
