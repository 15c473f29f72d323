// SPDX-License-Identifier: Apache-2.0
#include "client/load/report/comparison_report.h"

#include <nlohmann/json.hpp>

#include "base/text.h"
#include "report/table.h"

namespace furrow::load {
namespace {

using furrow::Counted;
using furrow::report::Fixed;

std::string RangeText(const Quartiles& quartiles, int digits) {
  return Fixed(quartiles.low, digits) + " to " + Fixed(quartiles.high, digits);
}

// Figures without a pair have dashes instead of ratios.
std::string TableOf(const Comparison& comparison) {
  report::Table table{comparison.rounds == 0 ? "Comparison with a raw UDP echo"
                                             : "Comparison with a raw UDP echo, " +
                                                   Counted(comparison.rounds, "round"),
                      {"figure", "daemon", "raw echo", "ratio", "ratio, quartiles", "control",
                       "control, quartiles"},
                      {}};
  for (const Figure& figure : comparison.figures) {
    table.rows.push_back({figure.name + ", " + figure.unit, Fixed(figure.server, 1),
                          Fixed(figure.raw, 1), Fixed(figure.ratio.median, 2),
                          RangeText(figure.ratio, 2), Fixed(figure.control.median, 2),
                          RangeText(figure.control, 2)});
  }
  for (const UnpairedFigure& figure : comparison.not_compared) {
    table.rows.push_back(
        {figure.name + ", " + figure.unit, Fixed(figure.server, 1), "-", "-", "-", "-", "-"});
  }
  return ToMarkdown(table);
}

std::string HighestRate(const Comparison& comparison) {
  const Quartiles rates = QuartilesOf(comparison.highest_rates);
  // In these three cases something else than the server ended the search.
  const bool at_least =
      comparison.at_limit || comparison.unfinished || comparison.generator_behind_at.has_value();
  const std::string text =
      std::string("\nHighest rate without loss and with p99 below the limit: ") +
      (at_least ? "at least " : "") + Fixed(rates.median, 0) + " poses per second";
  if (comparison.unfinished) return text + ".\n";
  return text + " (" + Counted(comparison.highest_rates.size(), "search", "searches") + ", " +
         RangeText(rates, 0) + "; precision " + Fixed(100.0 * (kSearchPrecision - 1.0), 0) +
         "%).\n";
}

// Remarks about anything that limits what the figures mean.
std::string ComparisonRemarks(const Comparison& comparison) {
  std::string text;
  const auto remark = [&text](const std::string& sentence) { text += sentence + "\n"; };
  if (comparison.at_limit)
    remark("A search reached its limit (--limit); the daemon may handle more.");
  if (comparison.unfinished)
    remark("The search did not finish in time; the daemon may handle more.");
  if (comparison.generator_behind_at) {
    remark("The load generator could not keep up at " + Fixed(*comparison.generator_behind_at, 0) +
           " poses per second; with a faster generator the daemon may sustain higher rates.");
  }
  if (comparison.raw_generator_behind_at) {
    remark("The load generator could not keep up with the raw echo at " +
           Fixed(*comparison.raw_generator_behind_at, 0) +
           " poses per second; the raw echo's highest rate is limited by the generator.");
  }
  if (comparison.no_cpu) {
    remark(
        "The daemon's processor time is unknown, so it is not compared. If the daemon runs on this "
        "machine, name its process with --pid.");
  }
  if (comparison.not_loopback) {
    remark(
        "HOST is not a loopback address, but the raw echoes run on this machine. Only the daemon's "
        "figures include the network.");
  }
  if (comparison.out_of_time)
    remark("The measurement did not finish within --time-limit; these are the figures so far.");
  if (comparison.interrupted) remark("Interrupted: these are the figures so far.");
  if (!comparison.failure.ok())
    remark("The measurement ended early: " + comparison.failure.ToString() + ".");
  return text;
}

nlohmann::json StepsOf(const Comparison& comparison) {
  nlohmann::json steps = nlohmann::json::array();
  for (const RateStep& step : comparison.steps) {
    steps.push_back({{"rate", step.rate},
                     {"p50_us", step.p50_us},
                     {"p99_us", step.p99_us},
                     {"lost_share", step.lost_share},
                     {"held", step.held},
                     {"generator_behind", step.generator_behind}});
  }
  return steps;
}

}  // namespace

std::string ToText(const Comparison& comparison) {
  std::string text;
  if (!comparison.figures.empty() || !comparison.not_compared.empty()) text += TableOf(comparison);
  if (!comparison.highest_rates.empty()) text += HighestRate(comparison);
  return text + ComparisonRemarks(comparison);
}

nlohmann::json ToJson(const Comparison& comparison) {
  const auto quartiles = [](const Quartiles& value) {
    return nlohmann::json{{"median", value.median}, {"low", value.low}, {"high", value.high}};
  };
  // null in JSON means that the rate does not exist; 0 would be a rate.
  const auto rate = [](const std::optional<double>& value) {
    return value ? nlohmann::json(*value) : nlohmann::json();
  };
  nlohmann::json figures = nlohmann::json::array();
  for (const Figure& figure : comparison.figures) {
    figures.push_back({{"name", figure.name},
                       {"unit", figure.unit},
                       {"daemon", figure.server},
                       {"raw", figure.raw},
                       {"ratio", quartiles(figure.ratio)},
                       {"control", quartiles(figure.control)}});
  }
  for (const UnpairedFigure& figure : comparison.not_compared) {
    figures.push_back({{"name", figure.name},
                       {"unit", figure.unit},
                       {"daemon", figure.server},
                       {"raw", nullptr},
                       {"ratio", nullptr},
                       {"control", nullptr}});
  }
  return {{"figures", figures},
          {"rounds", comparison.rounds},
          {"highest_rates", comparison.highest_rates},
          {"search_precision", kSearchPrecision},
          {"steps", StepsOf(comparison)},
          {"generator_behind_at", rate(comparison.generator_behind_at)},
          {"raw_generator_behind_at", rate(comparison.raw_generator_behind_at)},
          {"at_limit", comparison.at_limit},
          {"unfinished", comparison.unfinished},
          {"out_of_time", comparison.out_of_time},
          {"interrupted", comparison.interrupted},
          {"failure", comparison.failure.ok() ? "" : comparison.failure.ToString()}};
}

}  // namespace furrow::load
