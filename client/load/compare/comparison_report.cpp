// SPDX-License-Identifier: Apache-2.0
#include "client/load/compare/comparison_report.h"

#include <nlohmann/json.hpp>

#include "report/table.h"
#include "report/words.h"

namespace furrow::load {
namespace {

using furrow::report::Counted;
using furrow::report::Fixed;

std::string Between(const Spread& spread, int digits) {
  return Fixed(spread.low, digits) + " to " + Fixed(spread.high, digits);
}

std::string TableOf(const Comparison& comparison) {
  report::Table table{
      comparison.rounds == 0
          ? "Beside a raw UDP echo"
          : "Beside a raw UDP echo, " + Counted(comparison.rounds, "round") + " of runs in turn",
      {"figure", "daemon", "raw echo", "ratio", "middle half of the ratios", "raw against raw",
       "its middle half"},
      {}};
  for (const Figure& figure : comparison.figures) {
    table.rows.push_back({figure.name + ", " + figure.unit, Fixed(figure.server, 1),
                          Fixed(figure.raw, 1), Fixed(figure.ratio.median, 2),
                          Between(figure.ratio, 2), Fixed(figure.control.median, 2),
                          Between(figure.control, 2)});
  }
  for (const LoneFigure& figure : comparison.not_compared) {
    table.rows.push_back(
        {figure.name + ", " + figure.unit, Fixed(figure.server, 1), "-", "-", "-", "-", "-"});
  }
  return ToMarkdown(table);
}

std::string HighestRate(const Comparison& comparison) {
  const Spread spread = SpreadOf(comparison.highest_rates);
  const bool at_least =
      comparison.at_limit || comparison.unfinished || comparison.generator_behind_at.has_value();
  const std::string text = std::string("\nHighest rate that loses nothing and holds p99: ") +
                           (at_least ? "at least " : "") + Fixed(spread.median, 0) +
                           " poses a second";
  if (comparison.unfinished) return text + ".\n";
  return text + " (" + Counted(comparison.highest_rates.size(), "search", "searches") + ", " +
         Between(spread, 0) + "; each to " + Fixed(100.0 * (kSearchPrecision - 1.0), 0) + "%).\n";
}

// What makes the figures say less than they seem to.
std::string Remarks(const Comparison& comparison) {
  std::string text;
  const auto remark = [&text](const std::string& sentence) { text += sentence + "\n"; };
  if (comparison.at_limit)
    remark("A search ended at its limit (--limit): the daemon may take more.");
  if (comparison.unfinished)
    remark("The search was not finished in time: the daemon may take more.");
  if (comparison.generator_behind_at) {
    remark(
        "The generator could not keep up at " + Fixed(*comparison.generator_behind_at, 0) +
        " poses a second: what the daemon did not hold from there on it might from a faster one.");
  }
  if (comparison.raw_generator_behind_at) {
    remark("The generator could not keep up with the raw echo at " +
           Fixed(*comparison.raw_generator_behind_at, 0) +
           " poses a second: the raw echo's highest rate is rather the generator's.");
  }
  if (comparison.no_cpu) {
    remark(
        "The daemon's processor time is not known, so it is not compared: name its process by "
        "--pid, where it runs on this machine.");
  }
  if (comparison.not_loopback) {
    remark(
        "HOST is not a loopback address, but the raw echoes are on this machine: the way to the "
        "daemon is in its figures and not in theirs.");
  }
  if (comparison.out_of_time)
    remark("Not everything was measured within --time-limit: these are the figures so far.");
  if (comparison.interrupted) remark("Interrupted: these are the figures so far.");
  if (!comparison.failure.ok())
    remark("Ended before its time: " + comparison.failure.ToString() + ".");
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
  return text + Remarks(comparison);
}

nlohmann::json ToJson(const Comparison& comparison) {
  const auto spread = [](const Spread& value) {
    return nlohmann::json{{"median", value.median}, {"low", value.low}, {"high", value.high}};
  };
  const auto rate = [](const std::optional<double>& value) {
    return value ? nlohmann::json(*value) : nlohmann::json();
  };
  nlohmann::json figures = nlohmann::json::array();
  for (const Figure& figure : comparison.figures) {
    figures.push_back({{"name", figure.name},
                       {"unit", figure.unit},
                       {"daemon", figure.server},
                       {"raw", figure.raw},
                       {"ratio", spread(figure.ratio)},
                       {"control", spread(figure.control)}});
  }
  for (const LoneFigure& figure : comparison.not_compared) {
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
