// SPDX-License-Identifier: Apache-2.0
#include "client/cli/cli.h"

#include <charconv>
#include <csignal>
#include <cstdio>
#include <exception>

#include "client/cli/command.h"
#include "client/cli/exit_code.h"

namespace furrow::cli {

void AddSkeletonMap(CLI::App& command, std::string& value) {
  command.add_option("--skeleton-map", value,
                     "What the recording calls its joints: a map's name or file (cmu, mixamo, vrm "
                     "...); default: the best of those that ship");
}

bool ParseSize(const std::string& text, int* width, int* height) {
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, *width);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != 'x') return false;
  const auto second = std::from_chars(first.ptr + 1, end, *height);
  const auto in_range = [](int value) { return value >= 16 && value <= 4096; };
  return second.ec == std::errc() && second.ptr == end && in_range(*width) && in_range(*height);
}

CLI::Validator SizeValidator() {
  return {[](std::string& text) {
            int width = 0;
            int height = 0;
            if (ParseSize(text, &width, &height)) return std::string();
            return "'" + text + "' is not WIDTHxHEIGHT with both in 16..4096, as 640x480";
          },
          "WxH"};
}

CLI::Validator Within(double least, double most) {
  const std::string range = CLI::Range(least, most).get_description();
  return {[=](std::string& text) {
            double number = 0.0;
            const bool is_number = CLI::detail::lexical_cast(text, number);
            if (is_number && number >= least && number <= most) return std::string();
            return "'" + text + "' is not of " + range;
          },
          range};
}

namespace {

int ParseAndRun(int argc, const char* const* argv) {
  CLI::App app("Furrow: wrinkle weights and pictures from live and recorded poses", "furrow");
  app.set_version_flag("--version", "furrow " FURROW_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, 1 failed at run time, 2 wrong usage, 3 bad input, 4 no connection.\n"
      "Files that a rig names are looked up beside it, then in the folders of FURROW_ASSET_PATH.");
  Action action;
  AddPlay(app, action);
  AddWatch(app, action);
  AddFrames(app, action);
  AddRecord(app, action);
  AddLoad(app, action);
  AddChaos(app, action);
  AddSolve(app, action);
  AddRender(app, action);
  AddRig(app, action);
  AddConvert(app, action);
  AddInfo(app, action);
  AddCharacter(app, action);
  AddBake(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kUsage;
  }
  return action();
}

}  // namespace

int Run(int argc, const char* const* argv) {
  // A closed pipe (`furrow solve ... | head`) ends the output, which the writers notice, not the
  // program by a signal.
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return ParseAndRun(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "furrow: %s\n", error.what());
    return kFailed;
  }
}

}  // namespace furrow::cli
