// SPDX-License-Identifier: Apache-2.0
#include "bench/load/cold.h"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "bench/load/beside_echoes.h"
#include "bench/load/paired_runs.h"
#include "bench/report/value_or_exit.h"
#include "client/load/report/comparison_report.h"
#include "protocol/secure/token/key_ring.h"
#include "report/table.h"

namespace furrow::bench {
namespace {

namespace secure = protocol::secure;
using report::Fixed;

constexpr double kRates[] = {1000.0, 5000.0, 10000.0, 20000.0, 50000.0};
// Longer than the time between two poses at every rate.
constexpr int kBusyPollUs = 2000;

// Writes keys of tokens and returns a token of one of them, for everything that a tester does.
secure::ClientToken MakeKeys(const std::filesystem::path& file) {
  constexpr std::uint64_t kDay = 86400;
  const auto now = static_cast<std::uint64_t>(std::time(nullptr));
  secure::KeyRing ring;
  (void)ValueOrExit(ring.AddNew(now, now + kDay, secure::SystemRandom()));
  if (const Status status = secure::SaveKeyRing(ring, file); !status.ok()) FailWith(status);
  const secure::TokenKey& key = *ring.Newest(now);
  secure::Grant grant;
  grant.roles = secure::Roles(secure::Role::kPublish) | secure::Role::kWatch;
  return ValueOrExit(secure::MakeToken(key.id, key.key, now + kDay, grant, secure::SystemRandom()));
}

struct Way {
  std::string name;
  DaemonSetup setup;
  std::optional<secure::ClientToken> token;
};

// "1.18 (1.10 to 1.22), 1.01": the ratio, and that of the raw echoes.
std::string Ratio(const ColdRow& row, const std::string& name) {
  const load::Figure* figure = FindFigure(row.comparison, name);
  if (figure == nullptr) return "";
  return Between(figure->ratio) + ", " + Fixed(figure->control.median, 2);
}

std::string RawP50(const ColdRow& row) {
  const load::Figure* figure = FindFigure(row.comparison, "p50");
  return figure == nullptr ? "" : Fixed(figure->raw, 0) + " us";
}

std::vector<std::string> Cells(const ColdRow& row) {
  return {row.way,           row.cores,         Fixed(row.rate, 0),      RawP50(row),
          Ratio(row, "p50"), Ratio(row, "p90"), Ratio(row, "CPU a pose")};
}

std::vector<ColdRow> MeasureWay(const LoadSetup& setting, const Way& way) {
  const BesideEchoes servers(setting, way.setup);
  load::ComparisonTargets targets = servers.targets();
  targets.server.security.token = way.token;
  PairedRuns duel(setting, targets, 0);
  std::vector<ColdRow> rows;
  const std::string cores = way.setup.is_pinned ? "one each" : "any";
  for (const double rate : kRates) {
    const ColdRow& row = rows.emplace_back(ColdRow{way.name, cores, rate, duel.At(rate)});
    for (const std::string& cell : Cells(row)) std::fprintf(stderr, "%s | ", cell.c_str());
    std::fprintf(stderr, "\n");
  }
  return rows;
}

}  // namespace

std::vector<ColdRow> MeasureCold(const LoadSetup& asked) {
  // Twenty comparisons: short rounds, so that a machine that changes its pace affects whole rounds.
  LoadSetup setting = asked;
  setting.rounds = std::min(asked.rounds, 5);
  setting.seconds = std::min(asked.seconds, 1.0);
  const std::filesystem::path keys = setting.folder / "keys";
  const secure::ClientToken token = MakeKeys(keys);
  // First those that may use any core: afterwards this program keeps to the others.
  const Way ways[] = {{"plain", {.is_pinned = false}, {}},
                      {"busy polling", {.busy_poll_us = kBusyPollUs}, {}},
                      {"plain", {}, {}},
                      {"secure", {.keys = keys}, token}};
  std::vector<ColdRow> rows;
  for (const Way& way : ways) {
    for (ColdRow& row : MeasureWay(setting, way)) rows.push_back(std::move(row));
  }
  return rows;
}

std::string ToMarkdown(const std::vector<ColdRow>& rows) {
  report::Table table{"The daemon compared with a raw echo; after the comma, raw against raw",
                      {"way", "cores", "poses/s", "raw echo, p50", "p50", "p90", "CPU a pose"},
                      {}};
  for (const ColdRow& row : rows) table.rows.push_back(Cells(row));
  return report::ToMarkdown(table);
}

nlohmann::json ToJson(const std::vector<ColdRow>& rows) {
  nlohmann::json json = nlohmann::json::array();
  for (const ColdRow& row : rows) {
    json.push_back({{"way", row.way},
                    {"cores", row.cores},
                    {"poses_per_second", row.rate},
                    {"comparison", load::ToJson(row.comparison)}});
  }
  return json;
}

}  // namespace furrow::bench
