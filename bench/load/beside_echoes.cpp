// SPDX-License-Identifier: Apache-2.0
#include "bench/load/beside_echoes.h"

#include "bench/report/value_or_exit.h"

namespace furrow::bench {
namespace {

load::Target TargetOf(const load::EchoServer& server) {
  return {.host = "127.0.0.1", .udp = server.port(), .echo = true, .pid = server.pid()};
}

}  // namespace

BesideEchoes::BesideEchoes(const LoadSetup& setting, const DaemonSetup& setup)
    : daemon_(
          ValueOrExit(DaemonProcess::Start(setting.daemon, setting.rig, setting.folder, setup))),
      raw_(ValueOrExit(load::EchoServer::Start(daemon_.target().pid))),
      control_(ValueOrExit(load::EchoServer::Start(daemon_.target().pid))) {}

load::ComparisonTargets BesideEchoes::targets() const {
  return {.server = daemon_.target(), .raw = TargetOf(raw_), .control = TargetOf(control_)};
}

}  // namespace furrow::bench
