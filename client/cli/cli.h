// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace furrow::cli {

// The whole of `furrow`: parses, runs, returns the exit code. Never throws.
int Run(int argc, const char* const* argv);

}  // namespace furrow::cli
