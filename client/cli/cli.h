// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace furrow::cli {

// Runs the program `furrow`: the command that the arguments name. Returns the exit code. Commands
// of a helper program (furrow-load, furrow-author) replace this process by it. Never throws.
int Run(int argc, const char* const* argv);

}  // namespace furrow::cli
