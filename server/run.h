// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/config/config.h"
#include "server/core/exit_code.h"
#include "server/run_options.h"

namespace furrow::server {

// Runs a daemon: loads its files, listens, prints 'furrowd ready ...' on stdout, serves until it is
// asked to stop, then sends what is still queued and closes the connections. Errors are logged
// before the function returns.
//
// The calling thread becomes the network thread of shard 0 (a shard is one network thread's share
// of the subjects). Further threads: Config::threads - 1 that receive UDP, one that renders, one
// for the web server, one for the recorder. Several daemons may run in one process.
[[nodiscard]] ExitCode Run(const Config& config, const RunOptions& options = {});

// Reads what Run() would read before it serves, except pictures, and looks whether it may record.
// Logs what is wrong, or prints on stdout that the configuration is valid. Opens no ports, starts
// no renderer and writes no files.
[[nodiscard]] ExitCode Check(const Config& config);

}  // namespace furrow::server
