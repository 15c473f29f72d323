// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <istream>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace furrow::bench {

// On what, when, and beside how much other work something is measured.
struct Machine {
  std::string date;       // "2026-11-21 18:30 UTC"
  std::string processor;  // its name
  int cores = 0;          // that this program may use
  double load = 0.0;      // runnable tasks of the machine, the last minute's average
  std::string compiler;   // of this program
};

// Call it before anything is measured.
[[nodiscard]] Machine ThisMachine();

// The first core's name as /proc/cpuinfo has it; "unknown processor" where it has none.
[[nodiscard]] std::string ProcessorName(std::istream& cpuinfo);

// "2026-11-21 18:30 UTC, 2 cores of AMD EPYC, g++ 12.2.0"
[[nodiscard]] std::string ToText(const Machine& machine);
[[nodiscard]] nlohmann::json ToJson(const Machine& machine);

}  // namespace furrow::bench
