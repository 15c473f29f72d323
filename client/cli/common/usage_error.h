// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace furrow::cli {

// The message about a wrong command line, without "furrow: ". Names the option or the command that
// does not exist, the one that was probably meant, and where to look. Other errors keep CLI11's
// text. `app`: the application that parse() failed for.
[[nodiscard]] std::string UsageMessage(const CLI::App& app, const CLI::ParseError& error);

}  // namespace furrow::cli
