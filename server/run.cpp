// SPDX-License-Identifier: Apache-2.0
#include "server/run.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/joined.h"
#include "base/status.h"
#include "base/text.h"
#include "recording/take_folder.h"
#include "server/assets.h"
#include "server/cluster/setup/make_coordinator.h"
#include "server/core/metrics.h"
#include "server/credentials.h"
#include "server/daemon.h"
#include "server/machine/early_signals.h"
#include "server/machine/systemd_copy.h"
#include "server/net/clock.h"
#include "server/restart/inheritance.h"
#include "server/startup.h"

namespace furrow::server {
namespace {

ExitCode Fail(ExitCode code, const Status& status) {
  spdlog::error("{}", status.ToString());
  return code;
}

// Why a daemon cannot start.
struct Failure {
  ExitCode code = ExitCode::kFailed;
  Status status;
};

// Everything between construction and Serve().
std::optional<Failure> Prepare(Daemon& daemon) {
  if (Status status = daemon.LoadPlayer(); !status.ok()) {
    return Failure{ExitCode::kBadInput, status};
  }
  if (Status status = daemon.StartRendering(); !status.ok()) {
    return Failure{ExitCode::kFailed, status};
  }
  if (Status status = daemon.LoadCluster(); !status.ok()) {
    return Failure{
        status.code() == StatusCode::kUnavailable ? ExitCode::kFailed : ExitCode::kBadInput,
        status};
  }
  daemon.FinishConfinement();
  if (Status status = daemon.LoadCredentials(); !status.ok()) {
    return Failure{ExitCode::kBadInput, status};
  }
  // After all files that may have a fault, so that a failed start leaves no recording.
  if (Status status = daemon.StartRecording(); !status.ok()) {
    return Failure{ExitCode::kFailed, status};
  }
  if (Status status = daemon.Listen(); !status.ok()) return Failure{ExitCode::kFailed, status};
  return std::nullopt;
}

// True if the daemon was told to stop while it loads its files.
bool IsEarlyStop(const RunOptions& options) {
  if (!options.handle_signals || !early_signals::stop()) return false;
  spdlog::info("stopped before it was ready");
  return true;
}

ExitCode LoadAndServe(const Config& asked, const RunOptions& options) {
  // Tests and embedders call Run() without ParseCommandLine(), which has validated already.
  if (Status status = ValidateConfig(asked); !status.ok()) return Fail(ExitCode::kUsage, status);
  const Config config = WithoutMissingParts(asked);
  if (asked.render && !config.render) {
    spdlog::warn("no pictures: the package furrow-pictures is not installed; weights go on");
  }
  Inheritance former(options.kept, options.manager);
  // In a cluster, the store says which subjects a node serves.
  if (!config.cluster.enabled()) former.ReadState(ReadClock());
  // Pictures take seconds, and weights need none.
  Result<Assets> assets = LoadAssets(
      config, config.require_render ? character::Pictures::kLoad : character::Pictures::kLeaveOut);
  // Asked first, because the signal may have ended a helper program, and then the file seems
  // faulty.
  if (IsEarlyStop(options)) return ExitCode::kOk;
  if (!assets.ok()) return Fail(ExitCode::kBadInput, assets.status());
  WarnAboutSecurity(config);
  WarnAboutAssets(*assets);
  auto osc_outputs = LoadOscOutputs(config);
  if (!osc_outputs.ok()) return Fail(ExitCode::kBadInput, osc_outputs.status());
  Daemon daemon(config, options, *std::move(assets), *std::move(osc_outputs), &former);
  if (const auto failed = Prepare(daemon)) {
    return daemon.Abandon(IsEarlyStop(options) ? ExitCode::kOk
                                               : Fail(failed->code, failed->status));
  }
  // Which also stops in order, after a signal that came before.
  return daemon.Serve();
}

// What works for root may not work for the service.
void WarnIfOfRoot(const std::filesystem::path& path) {
  struct stat info {};
  if (geteuid() != 0 || path.empty() || stat(path.c_str(), &info) != 0) return;
  if (info.st_uid == 0 && (info.st_mode & S_IROTH) == 0) {
    spdlog::warn(
        "only root can read {}: a service with a user of its own gets it by "
        "LoadCredential=",
        path.string());
  }
}

Status CheckCredentials(Config config) {
  std::vector<std::string> skipped;
  if (IsSystemdCopy(config.security.keys)) {
    skipped.push_back(config.security.keys.string());
    config.security.keys.clear();
  }
  TlsFiles& tls = config.security.tls;
  const std::array tls_files = {tls.certificate, tls.key, tls.client_authority};
  // A certificate is checked together with its key.
  if (std::ranges::any_of(tls_files, IsSystemdCopy)) {
    for (const std::filesystem::path& path : tls_files) {
      if (!path.empty()) skipped.push_back(path.string());
    }
    tls = {};
  }
  if (!skipped.empty()) {
    spdlog::warn("not checked, because systemd copies them when it starts the service: {}",
                 Joined(skipped));
  }
  for (const auto& path : {config.security.keys, tls.certificate, tls.key}) WarnIfOfRoot(path);
  Metrics unused;
  return Credentials(config, &unused).Load();
}

// A daemon without its page serves all the same, and warns only after its start.
void WarnAboutPage(const HttpConfig& http) {
  const std::filesystem::path index = http.page / "index.html";
  std::error_code ignored;
  if (!http.enabled || http.page.empty() || std::filesystem::is_regular_file(index, ignored))
    return;
  spdlog::warn("http.page: {} does not exist: there is no web page", index.string());
}

// Root may read and write what the user of the service may not. The command has the user, the
// folders and the view of the file system of furrowd.service; a user with another name would become
// the owner of the service's files.
void WarnAboutRoot(const Config& config) {
  std::error_code ignored;
  // As sd_booted(3) asks.
  const bool has_services = std::filesystem::exists("/run/systemd/system", ignored);
  if (geteuid() != 0 || !has_services || config.source.empty()) return;
  spdlog::warn(
      "checked as root, which may read and write more than the service; to check with its rights, "
      "run: systemd-run --pipe --wait --collect -p User=furrowd -p DynamicUser=yes -p "
      "StateDirectory=furrow -p ProtectHome=yes furrowd --config {} --check",
      ShellWord(std::filesystem::absolute(config.source, ignored).string()));
}

Status CheckAll(const Config& config) {
  auto assets = LoadAssets(config, character::Pictures::kLeaveOut);
  FURROW_RETURN_IF_ERROR(assets);
  WarnAboutSecurity(config);
  WarnAboutAssets(*assets);
  WarnAboutPage(config.http);
  FURROW_RETURN_IF_ERROR(LoadOscOutputs(config));
  FURROW_RETURN_IF_ERROR(LoadPlayer(config));
  FURROW_RETURN_IF_ERROR(MakeCoordinator(config, 1));
  return CheckCredentials(config);
}

// Parts report errors as Status. Only the standard library and the event loop throw: without
// memory or threads.
template <class Work>
Status WithoutExceptions(const Work& work) {
  try {
    return work();
  } catch (const std::exception& error) {
    return {StatusCode::kInternal, error.what(), "furrowd"};
  }
}

}  // namespace

ExitCode Check(const Config& asked) {
  const Config config = WithoutMissingParts(asked);
  const Status status = WithoutExceptions([&] { return CheckAll(config); });
  if (!status.ok()) return Fail(ExitCode::kBadInput, status);
  if (const auto& folder = config.record.folder; !folder.empty()) {
    const Status writes = recording::CheckTakeFolder(folder).Within("record.dir");
    if (!writes.ok()) return Fail(ExitCode::kFailed, writes);
  }
  WarnAboutRoot(config);
  std::puts("the configuration is valid");
  return ExitCode::kOk;
}

ExitCode Run(const Config& config, const RunOptions& options) {
  ExitCode exit_code = ExitCode::kOk;
  const Status status = WithoutExceptions([&] {
    exit_code = LoadAndServe(config, options);
    return Status();
  });
  return status.ok() ? exit_code : Fail(ExitCode::kFailed, status);
}

}  // namespace furrow::server
