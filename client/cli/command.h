// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace furrow::cli {

// What the command line asked for, once it is parsed: run after CLI11 has checked everything.
using Action = std::function<int()>;

// Each adds one subcommand to `app` and, when it is chosen, sets `action`. A file each.
void AddSolve(CLI::App& app, Action& action);
void AddRender(CLI::App& app, Action& action);
void AddRig(CLI::App& app, Action& action);
void AddRigPatch(CLI::App& rig_group, Action& action);  // `furrow rig patch`
void AddConvert(CLI::App& app, Action& action);
void AddInfo(CLI::App& app, Action& action);
void AddCharacter(CLI::App& app, Action& action);
void AddBake(CLI::App& app, Action& action);
void AddPlay(CLI::App& app, Action& action);
void AddRecord(CLI::App& app, Action& action);
void AddWatch(CLI::App& app, Action& action);
void AddFrames(CLI::App& app, Action& action);
void AddLoad(CLI::App& app, Action& action);
void AddChaos(CLI::App& app, Action& action);

// An option that takes one of some words, whatever their case; help shows "csv|jsonl|table".
template <class T>
CLI::Option* AddChoice(CLI::App& app, const std::string& name, T& value,
                       const std::map<std::string, T>& choices, const std::string& help) {
  std::string words;
  for (const auto& [word, meaning] : choices) words += (words.empty() ? "" : "|") + word;
  const auto to_number = [choices, words](std::string& text) {
    const auto found = choices.find(CLI::detail::to_lower(text));
    if (found == choices.end()) return "'" + text + "' is not one of " + words;
    text = std::to_string(static_cast<int>(found->second));
    return std::string();
  };
  return app.add_option(name, value, help)
      ->transform(CLI::Validator(to_number, ""))
      ->type_name(words);
}

// A CLI11 validator: a number of [least, most]; CLI::Range lets NaN pass.
[[nodiscard]] CLI::Validator Within(double least, double most);

// --skeleton-map, as LoadSkeletonMatcher() takes it.
void AddSkeletonMap(CLI::App& command, std::string& value);

// Parses "WxH" with both in [16, 4096].
[[nodiscard]] bool ParseSize(const std::string& text, int* width, int* height);
// A CLI11 validator for it.
[[nodiscard]] CLI::Validator SizeValidator();

}  // namespace furrow::cli
