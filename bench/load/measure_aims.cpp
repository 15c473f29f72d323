// SPDX-License-Identifier: Apache-2.0
#include "bench/load/measure_aims.h"

#include <cstdio>

#include "bench/load/beside_echoes.h"
#include "bench/load/paired_runs.h"
#include "bench/report/value_or_exit.h"
#include "client/load/run/verdict.h"
#include "report/table.h"

namespace furrow::bench {
namespace {

using report::Fixed;

constexpr int kSearches = 3;

// True if the ratio of a figure meets its limit, which is a maximum or a minimum.
Aim RatioAim(const load::Figure& figure, const std::string& what, double limit, bool at_most) {
  const double ratio = figure.ratio.median;
  return {what,
          "raw echo " + Fixed(figure.raw, 1) + " " + figure.unit,
          Between(figure.ratio) + "x",
          Between(figure.control) + "x",
          (at_most ? "<= " : ">= ") + Fixed(limit, 2) + "x",
          at_most ? ratio <= limit : ratio >= limit};
}

void AddRatios(const load::Comparison& comparison, const std::string& name, const std::string& what,
               double limit, bool at_most, std::vector<Aim>* aims) {
  const load::Figure* figure = FindFigure(comparison, name);
  if (figure != nullptr) aims->push_back(RatioAim(*figure, what, limit, at_most));
}

std::vector<Aim> EchoAims(const LoadSetup& setting) {
  const BesideEchoes servers(setting);
  PairedRuns duel(setting, servers.targets(), kSearches);
  std::vector<Aim> aims;
  const load::Comparison gentle = duel.At(10000.0);
  AddRatios(gentle, "p50", "round trip at 10,000 poses/s, p50", 1.25, true, &aims);
  AddRatios(gentle, "p90", "round trip at 10,000 poses/s, p90", 1.30, true, &aims);
  AddRatios(duel.At(50000.0), "CPU a pose", "processor time per pose at 50,000 poses/s", 2.0, true,
            &aims);
  AddRatios(duel.Highest(), "highest rate", "highest rate without loss", 0.5, false, &aims);
  return aims;
}

Aim ThousandSubjects(const LoadSetup& setting) {
  const auto run =
      ValueOrExit(RunFresh(setting, setting.recording, setting.rig, At60Hz(1000, setting.seconds)));
  const double p99_ms = run.p(99.0) * 1e-3;
  return {"1,000 subjects at 60 Hz on one core",
          "",
          std::to_string(run.tally.lost()) + " lost, " + std::to_string(run.tally.wrong) +
              " wrong, p99 " + Fixed(p99_ms, 2) + " ms",
          "",
          "0 lost, p99 < 16.7 ms",
          load::IsSustained(run, 1e6 / 60.0)};
}

// The memory of 1,000 subjects at a low pose rate, compared with that of one subject.
Aim IdleMemory(const LoadSetup& setting) {
  load::RunOptions options = At60Hz(1, 1.0);
  options.plan.rate = 2.0;
  const auto resident = [&](int subjects) {
    options.plan.subjects = subjects;
    const auto run = ValueOrExit(RunFresh(setting, setting.recording, setting.rig, options));
    return run.usage ? static_cast<double>(run.usage->resident_bytes) / (1 << 20) : 0.0;
  };
  const double one = resident(1);
  const double many = resident(1000);
  return {"memory with 1,000 subjects",
          "one subject " + Fixed(one, 1) + " MiB",
          Fixed(many, 1) + " MiB, " + Fixed((many - one) * 1024.0 / 999.0, 1) + " KiB a subject",
          "",
          "<= 64 MiB",
          many <= 64.0};
}

// Alternating runs with and without 40 subscribers that never read.
std::vector<Aim> Stalled(const LoadSetup& setting) {
  std::vector<double> p50;
  std::vector<double> p90;
  for (int round = 0; round < setting.rounds; ++round) {
    std::fprintf(stderr, "stalled subscribers, round %d\n", round + 1);
    load::RunOptions options = At60Hz(64, setting.seconds);
    const auto without = ValueOrExit(RunFresh(setting, setting.recording, setting.rig, options));
    options.misbehavior.stalled = 40;
    const auto with = ValueOrExit(RunFresh(setting, setting.recording, setting.rig, options));
    p50.push_back(with.p(50.0) / without.p(50.0));
    p90.push_back(with.p(90.0) / without.p(90.0));
  }
  const auto aim = [](const std::string& what, const std::vector<double>& ratios, double limit) {
    const load::Quartiles spread = load::QuartilesOf(ratios);
    return Aim{what,
               "none stalled",
               Between(spread) + "x",
               "",
               "<= " + Fixed(limit, 2) + "x",
               spread.median <= limit};
  };
  return {aim("40 stalled subscribers, p50", p50, 1.05),
          aim("40 stalled subscribers, p90", p90, 1.10)};
}

}  // namespace

std::vector<Aim> MeasureAims(const LoadSetup& setting) {
  std::vector<Aim> aims = EchoAims(setting);
  aims.push_back(ThousandSubjects(setting));
  for (Aim& aim : Stalled(setting)) aims.push_back(std::move(aim));
  aims.push_back(IdleMemory(setting));
  return aims;
}

}  // namespace furrow::bench
