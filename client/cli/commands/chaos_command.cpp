// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>

#include "client/chaos/proxy.h"
#include "client/cli/command.h"
#include "client/cli/endpoint.h"
#include "client/cli/exit_code.h"
#include "client/cli/interrupt.h"
#include "client/cli/load/chaos_flags.h"
#include "client/load/net/descriptor_limit.h"

namespace furrow::cli {
namespace {

struct ChaosCommand {
  std::string to;
  load::ChaosProxyOptions proxy;
  std::uint16_t to_tcp = 0;
  ChaosFlags flags;
};

int RunChaos(const ChaosCommand& command) {
  load::ChaosProxyOptions options = command.proxy;
  ReadChaosFlags(command.flags, &options.up, &options.down);
  Endpoint endpoint;
  if (!ParseEndpoint(command.to, client::TransportKind::kUdp, &endpoint)) {
    std::fprintf(stderr, "furrow: --to: '%s' is not HOST, HOST:PORT or [IPV6]:PORT\n",
                 command.to.c_str());
    return kUsage;
  }
  options.to_host = endpoint.host;
  options.to_udp = endpoint.port;
  options.to_tcp = command.to_tcp;
  const auto proxy = load::ChaosProxy::Open(options);
  if (!proxy.ok()) {
    const int code = Fail(proxy.status());
    switch (proxy.status().code()) {
      case StatusCode::kUnavailable: return kNoConnection;
      case StatusCode::kInvalidArgument: return kUsage;
      default: return code;
    }
  }
  CatchInterrupts();
  load::RaiseDescriptorLimit();
  std::printf("furrow chaos ready udp=%s:%u", options.listen_host.c_str(), (*proxy)->udp_port());
  if (options.to_tcp != 0)
    std::printf(" tcp=%s:%u", options.listen_host.c_str(), (*proxy)->tcp_port());
  std::printf("\n");
  std::fflush(stdout);
  (*proxy)->Run([] { return !Interrupted(); });
  const load::ChaosOutcome up = (*proxy)->up();
  const load::ChaosOutcome down = (*proxy)->down();
  std::printf("%s\n%s\n%s", ToText("up", up).c_str(), ToText("down", down).c_str(),
              NothingPlanted(up, down).c_str());
  return kDone;
}

}  // namespace

void AddChaos(CLI::App& app, Action& action) {
  auto options = std::make_shared<ChaosCommand>();
  CLI::App* command = app.add_subcommand(
      "chaos", "Stands between clients and a daemon and mistreats what passes, from a seed");
  command
      ->add_option(
          "--listen", options->proxy.listen_port,
          "UDP port for clients; 0: any free one, the line 'furrow chaos ready' says which")
      ->required();
  command->add_option("--bind", options->proxy.listen_host, "Numeric address to listen on")
      ->capture_default_str();
  command->add_option("--to", options->to, "HOST, HOST:PORT or [IPV6]:PORT of furrowd's UDP")
      ->required();
  auto* to_tcp = command->add_option(
      "--to-tcp", options->to_tcp,
      "furrowd's TCP port: opens one for clients, too. Of all below, TCP knows jitter and black "
      "holes");
  command
      ->add_option("--listen-tcp", options->proxy.listen_tcp_port,
                   "TCP port for clients; default: any free one, said like UDP's")
      ->needs(to_tcp);
  AddChaosFlags(*command, options->flags);
  command->callback([options, &action] { action = [options] { return RunChaos(*options); }; });
}

}  // namespace furrow::cli
