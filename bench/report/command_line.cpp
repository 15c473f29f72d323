// SPDX-License-Identifier: Apache-2.0
#include "bench/report/command_line.h"

#include <cstdlib>

#include <CLI/CLI.hpp>

namespace furrow::bench {

void ReadCommandLine(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    constexpr int kUsage = 2;
    std::exit(app.exit(error) == 0 ? 0 : kUsage);
  }
}

}  // namespace furrow::bench
