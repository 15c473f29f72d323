// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <spdlog/spdlog.h>

#include "server/config/config.h"
#include "server/config/log.h"
#include "server/daemon.h"
#include "server/machine/cache_folder.h"

namespace {

// The environment belongs to the process, so this is not the business of Run().
void PrepareCaches() {
  const std::filesystem::path folder = furrow::server::CacheFolder();
  if (folder.empty()) return;
  if (const furrow::Status status = furrow::server::PrepareCacheFolder(folder); !status.ok()) {
    spdlog::warn("shaders are compiled at every start: {}", status.ToString());
    return;
  }
  furrow::server::LetDriversCache(folder);
}

}  // namespace

int main(int argc, char** argv) {
  using furrow::server::ExitCode;
  const std::vector<std::string> args(argv + 1, argv + argc);
  const furrow::server::CommandLine line = furrow::server::ParseCommandLine(args);
  if (!line.config) {
    std::fputs(line.text.c_str(), line.exit_code == ExitCode::kOk ? stdout : stderr);
    return static_cast<int>(line.exit_code);
  }
  // The readers of the log and of the ready line may close their pipes. The daemon continues.
  std::signal(SIGPIPE, SIG_IGN);
  const furrow::server::Log log(line.config->log_json);
  if (line.config->render) PrepareCaches();
  furrow::server::RunOptions options;
  options.handle_signals = true;
  options.confine = true;
  furrow::server::ServiceManager manager;
  if (furrow::server::ServiceManager::IsPresent()) options.manager = &manager;
  options.listeners = furrow::server::ServiceManager::TakeListeners();
  return static_cast<int>(furrow::server::Run(*line.config, options));
}
