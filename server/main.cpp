// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>
#include <unistd.h>

#include "base/process/memory_reserve.h"
#include "base/status.h"
#include "base/utc_time.h"
#include "character/pictures/picture_codec.h"
#include "server/config/config.h"
#include "server/config/config_entries.h"
#include "server/config/log.h"
#include "server/daemon_files.h"
#include "server/machine/cache_folder.h"
#include "server/machine/confine.h"
#include "server/machine/early_signals.h"
#include "server/machine/journal.h"
#include "server/net/clock.h"
#include "server/run.h"

namespace {

// The environment belongs to the process, so this is not the business of Run().
furrow::Status PrepareCaches(const furrow::server::Config& config) {
  if (!config.render || !furrow::character::IsPictureCodecInstalled()) return {};
  const std::filesystem::path folder = furrow::server::CacheFolder();
  if (folder.empty()) return {};
  FURROW_RETURN_IF_ERROR(furrow::server::PrepareCacheFolder(folder));
  furrow::server::LetDriversCache(folder);
  return {};
}

// Returns what holds now, for the log.
std::string ConfineAs(const furrow::server::Config& config) {
  if (!config.security.confine) return {};
  std::error_code ignored;  // the recorder reports it
  if (!config.record.folder.empty()) {
    std::filesystem::create_directories(config.record.folder, ignored);
  }
  return furrow::server::Confine(furrow::server::FilesOf(config));
}

// The first line of the log: what has started, when, and how it is configured.
void LogStart(const furrow::server::Config& config) {
  spdlog::info("furrowd {} started at {}, process {}, configuration {}: {}", FURROW_VERSION,
               furrow::FormatUtc(furrow::server::UnixSeconds()), getpid(),
               config.source.empty() ? "of the command line" : config.source.string(),
               furrow::server::ConfigSummary(config));
}

std::string WithoutLineEnd(std::string text) {
  while (text.ends_with('\n')) text.pop_back();
  return text;
}

furrow::Result<furrow::server::Config> ReadConfigAgain(const std::vector<std::string>& args) {
  furrow::server::CommandLine line = furrow::server::ParseCommandLine(args);
  if (line.config) return *std::move(line.config);
  return furrow::Status(furrow::StatusCode::kInvalidArgument, WithoutLineEnd(line.text));
}

}  // namespace

int main(int argc, char** argv) {
  using furrow::server::ExitCode;
  const std::vector<std::string> args(argv + 1, argv + argc);
  const furrow::server::CommandLine line = furrow::server::ParseCommandLine(args);
  if (!line.config) {
    const bool failed = line.exit_code != ExitCode::kOk;
    const bool is_journal = failed && furrow::server::StderrIsJournal();
    if (failed && line.log_json) {
      const furrow::server::Log log({.json = true, .journal = is_journal});
      spdlog::error("{}", WithoutLineEnd(line.text));
      return static_cast<int>(line.exit_code);
    }
    const std::string text = is_journal ? furrow::server::AsJournalError(line.text) : line.text;
    std::fputs(text.c_str(), failed ? stderr : stdout);
    return static_cast<int>(line.exit_code);
  }
  if (line.check) {
    const furrow::server::Log log({.json = line.config->log_json, .level = line.config->log_level});
    return static_cast<int>(furrow::server::Check(*line.config));
  }
  furrow::server::early_signals::Install();
  // The readers of the log and of the ready line may close their pipes. The daemon continues.
  std::signal(SIGPIPE, SIG_IGN);
  const furrow::Status caches = PrepareCaches(*line.config);
  // Before the first thread, that of the log, because threads inherit it.
  const std::string confined = ConfineAs(*line.config);
  const furrow::server::Log log({.json = line.config->log_json,
                                 .level = line.config->log_level,
                                 .journal = furrow::server::StderrIsJournal()});
  furrow::MemoryReserve::Install();
  LogStart(*line.config);
  if (!caches.ok()) spdlog::warn("shaders are compiled at every start: {}", caches.ToString());
  furrow::server::RunOptions options;
  options.handle_signals = true;
  options.owns_process = true;
  options.confined = confined;
  options.reload = [&args] { return ReadConfigAgain(args); };
  furrow::server::ServiceManager manager;
  if (furrow::server::ServiceManager::IsPresent()) options.manager = &manager;
  furrow::server::ServiceManager::Passed passed = furrow::server::ServiceManager::TakeSockets();
  options.listeners = std::move(passed.listeners);
  options.kept = std::move(passed.kept);
  return static_cast<int>(furrow::server::Run(*line.config, options));
}
