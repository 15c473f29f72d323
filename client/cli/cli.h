// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace furrow::cli {

// The program `furrow`: runs the command that the arguments name and returns the exit code. Helper
// commands replace the process (common/helper_program.h). Never throws.
int Run(int argc, const char* const* argv);

}  // namespace furrow::cli
