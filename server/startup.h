// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "base/status.h"
#include "character/character.h"
#include "protocol/mocap/osc_out.h"
#include "server/assets.h"
#include "server/config/config.h"
#include "server/playback/player.h"

namespace furrow::server {

// What a daemon settles before its parts start.

// An installation without the module of pictures sends weights alone.
[[nodiscard]] Config WithoutMissingParts(Config config);

// The OSC targets of the configuration, each with its profile.
using OscOutputs = std::vector<std::pair<OscTargetConfig, protocol::mocap::OscProfile>>;

// Errors: those of LoadOscProfile().
[[nodiscard]] Result<OscOutputs> LoadOscOutputs(const Config& config);

// The recording of --play; null without one. Errors: motion::FindRecording(), Player::Load().
[[nodiscard]] Result<std::unique_ptr<Player>> LoadPlayer(const Config& config);

// Log what the operator may not expect.
void WarnAboutSecurity(const Config& config);
void WarnAboutAssets(const Assets& assets);
// WarnAboutAssets() includes it, unless the pictures come later.
void WarnAboutCharacter(const character::Character& character);

}  // namespace furrow::server
