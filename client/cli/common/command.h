// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>

#include <CLI/CLI.hpp>

#include "client/cli/common/endpoint.h"
#include "motion/clip/clip.h"

namespace furrow::cli {

// The work of a command with its parsed options; returns the exit code. It runs after CLI11 has
// checked the whole command line.
using Action = std::function<int()>;

// Adds an option that takes one of a set of words, in upper or lower case. Help shows the words
// ("csv|jsonl|table") and the default, which is the initial `value`. `value` must outlive parsing.
template <class T>
CLI::Option* AddChoice(CLI::App& app, const std::string& name, T& value,
                       const std::map<std::string, T>& choices, const std::string& help) {
  std::string words;
  std::string default_word;
  for (const auto& [word, meaning] : choices) {
    words += (words.empty() ? "" : "|") + word;
    if (meaning == value) default_word = word;
  }
  const auto to_number = [choices, words](std::string& text) {
    const auto found = choices.find(CLI::detail::to_lower(text));
    if (found == choices.end()) return "'" + text + "' is not one of " + words;
    text = std::to_string(static_cast<int>(found->second));
    return std::string();
  };
  return app.add_option(name, value, help)
      ->transform(CLI::Validator(to_number, ""))
      ->type_name(words)
      ->default_str(default_word);
}

// A validator for numbers in [least, most]. Unlike CLI::Range it rejects NaN.
[[nodiscard]] CLI::Validator Within(double least, double most);

// Adds --skeleton-map. `value` receives its argument, a name or a file, for LoadSkeletonMatcher().
void AddSkeletonMap(CLI::App& command, std::string& value);

// Adds --shape-map. `value` receives its argument, a name or a file, for LoadShapeMatcher().
void AddShapeMap(CLI::App& command, std::string& value);

// Adds the options of BVH files, --bvh-positions and --up-axis, for commands that read the
// recordings of a rig's reference poses and no others.
void AddBvhOptions(CLI::App& command, motion::LoadOptions& options);

// Adds the options that say how the recordings of a command are read: --animation,
// --bvh-positions, --rest-frame and --up-axis.
void AddReadOptions(CLI::App& command, motion::LoadOptions& options);

// Parses a picture size such as "640x480", both numbers in [16, 4096] pixels. Returns false and
// leaves the outputs unspecified if `text` is not one.
[[nodiscard]] bool ParseSize(const std::string& text, int* width, int* height);
// The validator of ParseSize().
[[nodiscard]] CLI::Validator SizeValidator();

// The help text of an argument that ParseHost() reads.
inline constexpr char kHostHelp[] =
    "Address of furrowd: HOST, HOST:PORT, [IPV6]:PORT or furrow://HOST:PORT?subject=NAME";

// Adds --token.
void AddTokenFile(CLI::App& command, std::string& value);
// Adds --token and the flags of TLS, for HostKeys::security.
void AddSecurityOptions(CLI::App& command, SecurityFlags& flags);

// The help text of --once.
inline constexpr char kOnceHelp[] =
    "End with exit code 4 if the connection is lost (default: connect again)";

}  // namespace furrow::cli
