// SPDX-License-Identifier: Apache-2.0
#include "bench/report/machine.h"

#include <array>
#include <cstdlib>
#include <ctime>
#include <fstream>

#include <nlohmann/json.hpp>
#include <sched.h>

namespace furrow::bench {
namespace {

std::string Now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 64> text{};
  const std::size_t size = std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M UTC", &utc);
  return {text.data(), size};
}

int NumCores() {
  cpu_set_t allowed;
  return sched_getaffinity(0, sizeof(allowed), &allowed) == 0 ? CPU_COUNT(&allowed) : 0;
}

}  // namespace

std::string ProcessorName(std::istream& cpuinfo) {
  for (std::string line; std::getline(cpuinfo, line);) {
    if (!line.starts_with("model name")) continue;
    const std::size_t at = line.find_first_not_of(" \t", line.find(':') + 1);
    if (at != std::string::npos) return line.substr(at);
  }
  return "unknown processor";
}

Machine ThisMachine() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  Machine machine{.date = Now(),
                  .processor = ProcessorName(cpuinfo),
                  .cores = NumCores(),
                  .load = 0.0,
#ifdef __clang__
                  .compiler = __VERSION__
#else
                  .compiler = "g++ " __VERSION__
#endif
  };
  (void)getloadavg(&machine.load, 1);
  return machine;
}

std::string ToText(const Machine& machine) {
  return machine.date + ", " + std::to_string(machine.cores) +
         (machine.cores == 1 ? " core of " : " cores of ") + machine.processor + ", " +
         machine.compiler;
}

nlohmann::json ToJson(const Machine& machine) {
  return {{"date", machine.date},
          {"processor", machine.processor},
          {"cores", machine.cores},
          {"load_before", machine.load},
          {"compiler", machine.compiler}};
}

}  // namespace furrow::bench
