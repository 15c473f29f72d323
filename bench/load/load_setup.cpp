// SPDX-License-Identifier: Apache-2.0
#include "bench/load/load_setup.h"

#include "base/status.h"
#include "client/cli/load/load_input.h"

namespace furrow::bench {

load::RunHooks Silently() {
  return {.keep_going = [] { return true; },
          .solving = [](double) {},
          .resolving = [](double) {},
          .second = [](double, const load::Tally&, const load::Histogram&) {}};
}

Result<load::RunResult> RunFresh(const LoadSetup& setting, const std::filesystem::path& recording,
                                 const std::filesystem::path& rig,
                                 const load::RunOptions& options) {
  const auto performance =
      cli::LoadWorkload({.file = recording, .rig = rig, .packing = cli::Packing::kAlways});
  FURROW_RETURN_IF_ERROR(performance);
  const auto daemon = DaemonProcess::Start(setting.daemon, rig, setting.folder);
  FURROW_RETURN_IF_ERROR(daemon);
  return load::Run(*performance, daemon->target(), options, Silently());
}

load::RunOptions At60Hz(int subjects, double seconds) {
  load::RunOptions options;
  options.plan = {.subjects = subjects, .phases = 16, .rate = 60.0, .seconds = seconds};
  return options;
}

}  // namespace furrow::bench
