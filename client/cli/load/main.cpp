// SPDX-License-Identifier: Apache-2.0
#include "client/cli/common/program.h"
#include "client/cli/load/commands.h"

int main(int argc, char** argv) {
  return furrow::cli::RunProgram(argc, argv, [](CLI::App& app, furrow::cli::Action& action) {
    furrow::cli::AddLoad(app, action);
    furrow::cli::AddChaos(app, action);
    furrow::cli::AddPlan(app, action);
  });
}
