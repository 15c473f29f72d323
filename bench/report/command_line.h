// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

namespace furrow::bench {

// Reads the command line. Exits the program with status 0 after --help, and with status 2 and a
// message on stderr after an invalid command line.
void ReadCommandLine(CLI::App& app, int argc, char** argv);

}  // namespace furrow::bench
