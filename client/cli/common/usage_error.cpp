// SPDX-License-Identifier: Apache-2.0
#include "client/cli/common/usage_error.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "base/text.h"

namespace furrow::cli {
namespace {

using Words = std::vector<std::string>;

// The command that was asked for, as far as the command line was understood, and its words.
const CLI::App& Chosen(const CLI::App& app, std::string* words) {
  *words = app.get_name();
  const CLI::App* chosen = &app;
  while (!chosen->get_subcommands().empty()) {
    chosen = chosen->get_subcommands().front();
    *words += " " + chosen->get_name();
  }
  return *chosen;
}

Words CommandsOf(const CLI::App& app) {
  Words names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    // Groups of options are commands without a name.
    if (!command->get_name().empty()) names.push_back(command->get_name());
  }
  return names;
}

Words OptionsOf(const CLI::App& app) {
  Words names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

// What CLI11 says in the words of its source: "Could not convert: --listen = 99999" and "--to: 1
// required TEXT missing".
std::string Plain(const CLI::ParseError& error) {
  const std::string text = error.what();
  constexpr std::string_view kConvert = "Could not convert: ";
  if (const auto at = text.find(" = "); text.starts_with(kConvert) && at != std::string::npos) {
    return text.substr(kConvert.size(), at - kConvert.size()) + ": " + Quoted(text.substr(at + 3)) +
           " is not a valid value";
  }
  const auto colon = text.find(": 1 required ");
  if (colon != std::string::npos && text.ends_with(" missing")) {
    return text.substr(0, colon) + " needs a value";
  }
  return text;
}

}  // namespace

std::string UsageMessage(const CLI::App& app, const CLI::ParseError& error) {
  std::string words;
  const CLI::App& chosen = Chosen(app, &words);
  // CLI11 complains first about what is missing, which is often what was misspelt.
  const Words extra = app.remaining(/*recurse=*/true);
  const auto option = std::find_if(extra.begin(), extra.end(), [](const std::string& word) {
    return word.size() > 1 && word.starts_with('-');
  });
  if (option != extra.end()) {
    // An option may have its value behind it: --rate=30.
    return UnknownWord("option", option->substr(0, option->find('=')), OptionsOf(chosen), words);
  }
  const Words commands = CommandsOf(chosen);
  if (!extra.empty() && !commands.empty()) {
    return UnknownWord("command", extra.front(), commands, words);
  }
  if (!extra.empty()) {
    return "unexpected argument " + Quoted(extra.front()) + " ('" + words +
           " --help' shows the usage)";
  }
  if (!commands.empty() && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    return "a command is missing ('" + words + " --help' lists the commands)";
  }
  return Plain(error) + " ('" + words + " --help' explains the options)";
}

}  // namespace furrow::cli
