// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

namespace furrow::bench {

// Reads the command line, or ends the program: with exit status 0 after --help, with 2 after one
// that is wrong, which stderr says.
void ReadCommandLine(CLI::App& app, int argc, char** argv);

}  // namespace furrow::bench
