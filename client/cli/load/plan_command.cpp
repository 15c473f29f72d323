// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "base/files.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/common/helper_program.h"
#include "client/cli/load/commands.h"
#include "client/plan/capacity.h"
#include "client/plan/plan_report.h"
#include "protocol/messages/limits.h"

namespace furrow::cli {
namespace {

struct PlanCommand {
  plan::Demand demand;
  plan::Machine machine;
  std::string size;
  std::string costs;
  std::string json;
};

constexpr std::size_t kMaxCostsBytes = 8 * 1024 * 1024;

Result<plan::Costs> LoadCosts(const std::string& path) {
  if (path.empty()) return plan::ShippedCosts();
  const auto text = ReadFile(path, kMaxCostsBytes);
  FURROW_RETURN_IF_ERROR(text);
  return plan::ReadCosts(*text, path);
}

int RunPlan(PlanCommand command) {
  plan::Demand& demand = command.demand;
  if (!command.size.empty() && !ParseSize(command.size, &demand.width, &demand.height)) {
    return kUsage;  // the validator of the option has checked it
  }
  const auto costs = LoadCosts(command.costs);
  if (!costs.ok()) return Fail(costs.status());
  const plan::Capacity capacity = plan::MakePlan(demand, *costs, command.machine);
  std::fputs(ToText(capacity, demand, command.machine, *costs).c_str(), stdout);
  if (command.json.empty()) return kDone;
  const Status status =
      WriteFileAtomically(command.json, ToJson(capacity, demand, command.machine).dump(2) + "\n");
  return status.ok() ? kDone : Fail(status);
}

void AddDemandOptions(CLI::App& command, plan::Demand& demand) {
  command.add_option("--performers", demand.performers, "Number of performers, all alike")
      ->required()
      ->check(Within(1.0, 1e9));
  command.add_option("--joints", demand.joints, "Joints of a performer")
      ->check(CLI::Range(0, protocol::kMaxJoints))
      ->capture_default_str();
  command.add_option("--blend-shapes", demand.blend_shapes, "Blend shapes of a performer")
      ->check(CLI::Range(0, protocol::kMaxBlendShapes))
      ->capture_default_str();
  command.add_option("--hz", demand.rate, "Poses per second of a performer")
      ->check(Within(0.1, 1000.0))
      ->capture_default_str();
  command
      .add_option("--weights", demand.weights,
                  "Wrinkle weights of a performer (the default character has 97)")
      ->check(CLI::Range(1, protocol::kMaxWeights))
      ->capture_default_str();
  command
      .add_option("--subscribers", demand.subscribers, "Subscribers of each performer's weights")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  command.add_flag("--floats", demand.floats, "Poses as floats (default: packed)");
  command.add_flag("--u8", demand.u8, "Weights of 8 bits (default: floats)");
  command.add_flag("--sealed", demand.is_sealed, "Connect tokens seal all datagrams");
}

void AddMachineOptions(CLI::App& command, plan::Machine& machine) {
  command.add_option("--cores", machine.cores, "Cores of a machine")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command
      .add_option("--gigabits", machine.gigabits,
                  "Speed of a machine's network link, in Gbit/s per direction")
      ->check(Within(0.01, 10000.0))
      ->capture_default_str();
  command
      .add_option("--load", machine.load,
                  "Share of each core and of the link that may be used; above 0.7, latency grows")
      ->check(Within(0.05, 1.0))
      ->capture_default_str();
  command.add_option("--spares", machine.spares, "Machines that may fail at a time")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
}

void AddPictureOptions(CLI::App& command, PlanCommand& options) {
  command
      .add_option("--viewers", options.demand.viewers,
                  "Viewers of pictures with skin shading, each with a camera of its own "
                  "(default: 0)")
      ->check(Within(0.0, 1e9));
  command.add_option("--size", options.size, "Size of the pictures, in pixels (default: 1280x720)")
      ->check(SizeValidator());
  command
      .add_option("--picture-rate", options.demand.picture_rate, "Pictures per second of a viewer")
      ->check(Within(0.1, 240.0))
      ->capture_default_str();
}

}  // namespace

void AddPlan(CLI::App& app, Action& action) {
  auto options = std::make_shared<PlanCommand>();
  CLI::App* command = app.add_subcommand("plan", HelpOf("plan"));
  AddDemandOptions(*command, options->demand);
  AddMachineOptions(*command, options->machine);
  AddPictureOptions(*command, *options);
  command->add_option(
      "--costs", options->costs,
      "What a pose costs on your machine: load.json, as bench_load --out writes it (default: the "
      "figures of docs/CAPACITY.md)");
  command->add_option("--json", options->json, "Write the figures to this JSON file");
  command->callback([options, &action] { action = [options] { return RunPlan(*options); }; });
}

}  // namespace furrow::cli
