// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/status.h"
#include "character/character.h"
#include "render/request/camera.h"

namespace furrow::render {

// Names of all camera presets: face, three_quarter, profile (from the subject's left), eyes, mouth,
// body, body_three_quarter, body_side (from the subject's left), body_back.
[[nodiscard]] std::span<const std::string_view> CameraPresetNames();
// "face, three_quarter, ...", for help texts.
[[nodiscard]] std::string ListCameraPresets();

// Computes the cameras of all presets for a character, as (name, camera) in the order of
// CameraPresetNames(), from the bounds of its rest pose, its rig's anchor joint and its joint
// names.
[[nodiscard]] std::vector<std::pair<std::string, Camera>> CameraPresets(
    const character::Character& character);

// Makes the error for the unknown preset `name`: kInvalidArgument, with a list of the valid names.
[[nodiscard]] Status UnknownPreset(std::string_view name);

}  // namespace furrow::render
