// SPDX-License-Identifier: Apache-2.0
#include "client/cli/token/key_command.h"

#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>

#include "base/text.h"
#include "base/utc_time.h"
#include "client/cli/common/exit_code.h"
#include "protocol/secure/token/key_ring.h"

namespace furrow::cli {
namespace {

namespace secure = protocol::secure;

struct KeyOptions {
  std::string file;
  std::string valid_for = "365d";
  std::string id;
};

int NewKey(const KeyOptions& options) {
  secure::KeyRing ring;
  std::error_code ignored;
  // A missing file is the first key; any other fault must not replace the file.
  if (std::filesystem::exists(options.file, ignored)) {
    auto loaded = secure::LoadKeyRing(options.file);
    if (!loaded.ok()) return Fail(loaded.status());
    ring = std::move(*loaded);
  }
  const std::uint64_t now = UnixNow();
  const std::uint64_t expires = now + *ParseDuration(options.valid_for);
  const auto id = ring.AddNew(now, expires, secure::SystemRandom());
  if (!id.ok()) return Fail(id.status().At(options.file));
  if (Status status = secure::SaveKeyRing(ring, options.file); !status.ok()) return Fail(status);
  std::printf("%s: new key %s until %s; %s in the file\n", options.file.c_str(),
              secure::KeyIdText(*id).c_str(), FormatUtc(expires).c_str(),
              Counted(ring.keys().size(), "key").c_str());
  return kDone;
}

int ListKeys(const KeyOptions& options) {
  const auto ring = secure::LoadKeyRing(options.file);
  if (!ring.ok()) return Fail(ring.status());
  const std::uint64_t now = UnixNow();
  const secure::TokenKey* const newest = ring->Newest(now);
  std::printf("%-8s  %-20s  %-20s  %s\n", "id", "created", "expires", "use");
  for (const secure::TokenKey& key : ring->keys()) {
    const char* use = &key == newest      ? "new tokens"
                      : now < key.expires ? "older tokens"
                                          : "none, expired";
    std::printf("%-8s  %-20s  %-20s  %s\n", secure::KeyIdText(key.id).c_str(),
                FormatUtc(key.created).c_str(), FormatUtc(key.expires).c_str(), use);
  }
  return kDone;
}

int RetireKey(const KeyOptions& options) {
  auto ring = secure::LoadKeyRing(options.file);
  if (!ring.ok()) return Fail(ring.status());
  std::uint32_t id = 0;
  if (!secure::ParseKeyId(options.id, id) || !ring->Remove(id)) {
    return Fail({StatusCode::kNotFound, "the file has no key " + Quoted(options.id), options.file,
                 "'furrow token key list' shows the ids"});
  }
  if (Status status = secure::SaveKeyRing(*ring, options.file); !status.ok()) return Fail(status);
  std::printf(
      "%s: removed key %s; its tokens are refused as soon as the daemon reads the file again: "
      "within a second, or when a service with LoadCredential= is restarted\n",
      options.file.c_str(), secure::KeyIdText(id).c_str());
  return kDone;
}

}  // namespace

std::uint64_t UnixNow() { return static_cast<std::uint64_t>(std::time(nullptr)); }

CLI::Validator DurationValidator() {
  return {[](std::string& text) {
            return ParseDuration(text)
                       ? std::string()
                       : "'" + text + "' is not a duration such as 90s, 30m, 8h, 14d";
          },
          ""};
}

std::string RemainingText(std::uint64_t expires, std::uint64_t now) {
  if (expires <= now) return "expired";
  const std::uint64_t minutes = (expires - now) / 60;
  if (minutes >= 2 * 1'440) return "in " + std::to_string(minutes / 1'440) + " days";
  return "in " + std::to_string(minutes / 60) + " h " + std::to_string(minutes % 60) + " min";
}

void AddTokenKey(CLI::App& token, Action& action) {
  CLI::App* group = token.add_subcommand("key", "Make, list and retire the keys that seal tokens");
  group->require_subcommand(1);
  auto options = std::make_shared<KeyOptions>();
  const auto add = [&](const char* name, const char* about, int (*run)(const KeyOptions&)) {
    CLI::App* command = group->add_subcommand(name, about);
    command->add_option("--key", options->file, kKeyFileHelp)->required()->type_name("FILE");
    command->callback(
        [options, run, &action] { action = [options, run] { return run(*options); }; });
    return command;
  };
  add("new", "Add a key to a file, or make the file; new tokens use this key", NewKey)
      ->add_option("--for", options->valid_for, "How long the key and its tokens are valid")
      ->check(DurationValidator())
      ->type_name("DURATION")
      ->capture_default_str();
  add("list", "Show the keys of a file, without the secrets", ListKeys);
  add("retire", "Remove a key from a file, which makes its tokens invalid", RetireKey)
      ->add_option("ID", options->id, "Id of the key, as 'list' shows it")
      ->required();
}

}  // namespace furrow::cli
