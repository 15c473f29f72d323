// SPDX-License-Identifier: Apache-2.0
#include "client/cli/common/program.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <string>

#include "client/cli/common/exit_code.h"
#include "client/cli/common/standard_output.h"
#include "client/cli/common/usage_error.h"

namespace furrow::cli {
namespace {

// States a default at the end of the help text, "(default: 10)", instead of after the option's
// type, "FLOAT=10".
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override {
    std::string text = CLI::Formatter::make_option_opts(option);
    const std::string value = "=" + option->get_default_str();
    const std::size_t at = value.size() > 1 ? text.find(value) : std::string::npos;
    return at == std::string::npos ? text : text.erase(at, value.size());
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    const std::string value = option->get_default_str();
    return option->get_description() + (value.empty() ? "" : " (default: " + value + ")");
  }
};

int ParseAndRun(int argc, const char* const* argv,
                const std::function<void(CLI::App& app, Action& action)>& add_commands) {
  CLI::App app("Furrow: compute wrinkle weights and pictures from live and recorded poses",
               "furrow");
  app.set_version_flag("--version", "furrow " FURROW_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, 1 failed at run time, 2 wrong usage, 3 bad input, 4 no connection.\n"
      "Files that a rig names are searched beside the rig, then in the folders of "
      "FURROW_ASSET_PATH.");
  app.formatter(std::make_shared<HelpFormatter>());
  Action action;
  add_commands(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // --help and --version are exceptions, too; exit() writes their text.
    if (error.get_exit_code() == 0) return app.exit(error);
    std::fprintf(stderr, "furrow: %s\n", UsageMessage(app, error).c_str());
    return kUsage;
  }
  return action();
}

// What the program has printed is its result, so losing it is a failure.
int WithOutputWritten(int exit_code) {
  std::cout.flush();
  errno = 0;
  const bool written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  return written || exit_code != kDone ? exit_code : StandardOutputFailed();
}

}  // namespace

int RunProgram(int argc, const char* const* argv,
               const std::function<void(CLI::App& app, Action& action)>& add_commands) {
  // A closed pipe (`furrow solve ... | head`) must reach the writers as an error instead of killing
  // the program with a signal.
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return WithOutputWritten(ParseAndRun(argc, argv, add_commands));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "furrow: %s\n", error.what());
    return kFailed;
  }
}

}  // namespace furrow::cli
