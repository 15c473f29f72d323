// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <istream>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace furrow::bench {

// The conditions of a measurement: machine, date and load.
struct Machine {
  std::string date;       // "2026-11-21 18:30 UTC"
  std::string processor;  // name
  int cores = 0;          // available to this program
  double load = 0.0;      // load average of the last minute
  std::string compiler;   // of this program
};

// Call this before the measurement, which raises the load.
[[nodiscard]] Machine ThisMachine();

// Returns the name of the first core in /proc/cpuinfo, or "unknown processor".
[[nodiscard]] std::string ProcessorName(std::istream& cpuinfo);

// "2026-11-21 18:30 UTC, 2 cores of AMD EPYC, g++ 12.2.0"
[[nodiscard]] std::string ToText(const Machine& machine);
[[nodiscard]] nlohmann::json ToJson(const Machine& machine);

}  // namespace furrow::bench
