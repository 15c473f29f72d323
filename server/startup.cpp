// SPDX-License-Identifier: Apache-2.0
#include "server/startup.h"

#include <string>

#include <spdlog/spdlog.h>

#include "character/pictures/picture_codec.h"
#include "motion/find_recording.h"
#include "server/config/osc_profile_file.h"

namespace furrow::server {

Config WithoutMissingParts(Config config) {
  config.render = config.render && (config.require_render || character::IsPictureCodecInstalled());
  return config;
}

Result<OscOutputs> LoadOscOutputs(const Config& config) {
  std::vector<OscTargetConfig> targets = config.osc.targets;
  if (config.osc_out) {
    targets.insert(targets.begin(), {.to = *config.osc_out, .prefix = config.osc_prefix});
  }
  OscOutputs outputs;
  for (OscTargetConfig& target : targets) {
    auto profile = LoadOscProfile(target.profile);
    if (!profile.ok()) return profile.status().Within("osc.target");
    outputs.emplace_back(std::move(target), *std::move(profile));
  }
  return outputs;
}

Result<std::unique_ptr<Player>> LoadPlayer(const Config& config) {
  if (config.play.empty()) return std::unique_ptr<Player>();
  const auto file = motion::FindRecording(config.play.string());
  if (!file.ok()) return file.status().At("--play");
  auto player = Player::Load(*file, PlayOptions(config));
  if (!player.ok()) return player.status().At("--play");
  return player;
}

void WarnAboutSecurity(const Config& config) {
  if (!ListensToNetwork(config)) return;
  const bool has_tls = config.security.tls.enabled();
  if (config.security.mode == Security::kOpen) {
    spdlog::warn(
        "open to the network: everybody who reaches {} may publish, watch and change settings",
        config.bind);
  } else if (has_tls) {
    return;
  } else if (config.security.tokens_in_clear) {
    spdlog::warn(
        "tokens over TCP and HTTP are not encrypted: everybody on the way can read and use them");
  } else {
    spdlog::info(
        "other computers are served over UDP only: TCP and HTTP are not encrypted without "
        "--tls-certificate");
  }
}

void WarnAboutAssets(const Assets& assets) {
  if (assets.rig->regions.empty()) {
    spdlog::warn(
        "the character has no wrinkle rig, so there are no weights and no wrinkles: put "
        "NAME.rig.json beside NAME.glb, or choose a rig by --rig");
  }
  if (!assets.lacks_pictures && assets.character != nullptr) WarnAboutCharacter(*assets.character);
}

void WarnAboutCharacter(const character::Character& character) {
  for (const std::string& warning : character.warnings) {
    spdlog::warn("character: {}", warning);
  }
  for (const std::string& name : character.missing_rig_pictures) {
    spdlog::warn("picture '{}' of the rig is missing; wrinkles that need it are not rendered",
                 name);
  }
}

}  // namespace furrow::server
