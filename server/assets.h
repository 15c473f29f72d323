// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/status.h"
#include "character/character.h"
#include "character/source_notes.h"
#include "render/settings/settings.h"
#include "rig/shapes/shape_match.h"
#include "rig/skeleton_match.h"
#include "server/config/config.h"
#include "wrinkle/rig/rig.h"
#include "wrinkle/shapes/joint_shapes.h"
#include "wrinkle/shapes/shape_rules.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::server {

// What streams need of a character: where its joints are, and its shapes, which a stream's joints
// may move.
struct CharacterShapes {
  wrinkle::Skeleton skeleton;
  std::vector<std::string> names;  // of the shapes
  std::vector<wrinkle::ShapeRule> rules;
  wrinkle::MovedSurface surface;
};

// The contents of the files that a daemon works with.
struct Assets {
  std::shared_ptr<const wrinkle::Rig> rig;
  std::shared_ptr<const character::Character> character;  // null: weights only
  bool lacks_pictures = false;                            // the character's were left out
  // The file of the character with the rig beside it. Empty: there is none, or the daemon uses
  // another rig.
  std::filesystem::path package;
  std::shared_ptr<const CharacterShapes> shapes;  // null: weights only, and joints move no shapes
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
// `pictures`: of the character; they take most of the time. Without them, nothing can be drawn.
[[nodiscard]] Result<Assets> LoadAssets(const Config& config,
                                        character::Pictures pictures = character::Pictures::kLoad);

// Loads the same files again with pictures. `former`: the character that was loaded without.
// Errors: those of LoadAssets(); kUnavailable, the files are no longer those of that character.
[[nodiscard]] Result<Assets> LoadWithPictures(
    const Config& config, const character::Character& former,
    character::Pictures pictures = character::Pictures::kLoad);

// The character for browsers, "<stem>.web.glb" beside `package`, with the rig in it. Reads the
// whole of both files, which takes longer than everything else that weights need. Empty: there is
// none, or it was made of another version of the character, which is logged.
[[nodiscard]] std::filesystem::path FindWebPackage(const std::filesystem::path& package);

}  // namespace furrow::server
