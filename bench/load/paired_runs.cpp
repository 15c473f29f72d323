// SPDX-License-Identifier: Apache-2.0
#include "bench/load/paired_runs.h"

#include <algorithm>
#include <cstdio>

#include "bench/report/aims.h"
#include "bench/report/value_or_exit.h"
#include "client/cli/load/load_input.h"
#include "client/net/clock.h"

namespace furrow::bench {
namespace {

constexpr int kSubjects = 256;

}  // namespace

PairedRuns::PairedRuns(const LoadSetup& setting, const load::ComparisonTargets& contestants,
                       int searches)
    : contestants_(contestants),
      performance_(ValueOrExit(cli::LoadWorkload(
          {.file = setting.recording, .rig = setting.rig, .packing = cli::Packing::kAlways}))) {
  options_.run = At60Hz(kSubjects, setting.seconds);
  options_.rounds = setting.rounds;
  options_.searches = std::min(searches, setting.rounds);
  options_.probe_seconds = std::min(1.0, setting.seconds);
  // Slower servers are searched from high to low rates.
  options_.search_start = 32000.0;
}

load::Comparison PairedRuns::At(double rate) {
  load::ComparisonOptions options = options_;
  options.run.plan.rate = rate / kSubjects;
  return Run(options);
}

load::Comparison PairedRuns::Highest() {
  load::ComparisonOptions options = options_;
  options.find_max = true;
  options.rounds = 0;
  return Run(options);
}

load::Comparison PairedRuns::Run(const load::ComparisonOptions& options) {
  load::Comparison comparison = load::Compare(
      [this](const load::Target& target, const load::RunOptions& run) {
        return load::Run(performance_, target, run, Silently());
      },
      contestants_, options,
      {.keep_going = [] { return true; },
       .progress = [](const std::string& what) { std::fprintf(stderr, "%s\n", what.c_str()); },
       .seconds = [] { return 1e-9 * static_cast<double>(net::SteadyNanoseconds()); }});
  if (!comparison.failure.ok()) FailWith(comparison.failure);
  return comparison;
}

const load::Figure* FindFigure(const load::Comparison& comparison, std::string_view name) {
  const auto found = std::ranges::find(comparison.figures, name, &load::Figure::name);
  return found == comparison.figures.end() ? nullptr : &*found;
}

std::string Between(const load::Quartiles& ratio) {
  return Between(ratio.median, ratio.low, ratio.high, 2);
}

}  // namespace furrow::bench
