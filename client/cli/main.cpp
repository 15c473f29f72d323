// SPDX-License-Identifier: Apache-2.0
#include "client/cli/cli.h"

int main(int argc, char** argv) { return furrow::cli::Run(argc, argv); }
