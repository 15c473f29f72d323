// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>

#include "client/chaos/proxy.h"
#include "client/cli/common/endpoint.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/common/helper_program.h"
#include "client/cli/common/interrupt.h"
#include "client/cli/load/chaos_flags.h"
#include "client/cli/load/commands.h"
#include "client/net/descriptor_limit.h"

namespace furrow::cli {
namespace {

struct ChaosCommand {
  std::string to;
  chaos::ProxyOptions proxy;
  std::uint16_t to_tcp = 0;
  ChaosFlags flags;
};

// Reads --to and --to-tcp. Prints the error and returns false if they are invalid. TLS passes the
// proxy as it is, so an address that states it means its TCP port.
bool ReadDaemon(const ChaosCommand& command, chaos::ProxyOptions* options) {
  const auto address = ParseHost(command.to, {.udp = true});
  if (!address) return false;
  const client::ClientTlsFiles& files = address->tls_files;
  const char* unused = nullptr;
  if (!address->subjects.empty()) unused = "subject";
  if (!address->token.empty()) unused = "token";
  if (!files.authority.empty() || !files.certificate.empty()) unused = "files of TLS";
  if (unused != nullptr) {
    std::fprintf(stderr, "furrow: --to: the proxy needs no %s (give it to the clients)\n", unused);
    return false;
  }
  const bool tcp = address->transport == client::TransportKind::kTcp;
  if (tcp && command.to_tcp != 0) {
    std::fprintf(stderr, "furrow: --to-tcp: --to names the TCP port, too (use one of both)\n");
    return false;
  }
  options->to_host = address->host;
  options->to_udp = tcp ? client::Address().PortFor(client::TransportKind::kUdp)
                        : address->PortFor(client::TransportKind::kUdp);
  options->to_tcp = tcp ? address->PortFor(client::TransportKind::kTcp) : command.to_tcp;
  return true;
}

int RunChaos(const ChaosCommand& command) {
  chaos::ProxyOptions options = command.proxy;
  ReadChaosFlags(command.flags, &options.up, &options.down);
  if (!ReadDaemon(command, &options)) return kUsage;
  const auto proxy = chaos::Proxy::Open(options);
  if (!proxy.ok()) {
    const int code = Fail(proxy.status());
    switch (proxy.status().code()) {
      case StatusCode::kUnavailable: return kNoConnection;
      case StatusCode::kInvalidArgument: return kUsage;
      default: return code;
    }
  }
  CatchInterrupts();
  net::RaiseDescriptorLimit();
  std::printf("furrow chaos ready udp=%s:%u", options.listen_host.c_str(), (*proxy)->udp_port());
  if (options.to_tcp != 0)
    std::printf(" tcp=%s:%u", options.listen_host.c_str(), (*proxy)->tcp_port());
  std::printf("\n");
  std::fflush(stdout);
  (*proxy)->Run([] { return !Interrupted(); });
  const chaos::Outcome up = (*proxy)->up();
  const chaos::Outcome down = (*proxy)->down();
  std::printf("%s\n%s\n%s", ToText("up", up).c_str(), ToText("down", down).c_str(),
              chaos::NothingInjected(up, down).c_str());
  return kDone;
}

}  // namespace

void AddChaos(CLI::App& app, Action& action) {
  auto options = std::make_shared<ChaosCommand>();
  CLI::App* command = app.add_subcommand("chaos", HelpOf("chaos"));
  command
      ->add_option("--listen", options->proxy.listen_port,
                   "UDP port for clients; 0 picks a free port and prints it in the line "
                   "'furrow chaos ready'")
      ->required();
  command->add_option("--bind", options->proxy.listen_host, "Numeric address to listen on")
      ->capture_default_str();
  command
      ->add_option("--to", options->to,
                   "UDP address of furrowd: HOST, HOST:PORT or [IPV6]:PORT; the port defaults to "
                   "7401. furrow://HOST:PORT?tls=1 names the TCP port; TLS passes unchanged")
      ->required();
  auto* to_tcp =
      command->add_option("--to-tcp", options->to_tcp,
                          "TCP port of furrowd, to proxy TCP too; only --jitter and --black-hole "
                          "apply to TCP (default: UDP only)");
  command
      ->add_option("--listen-tcp", options->proxy.listen_tcp_port,
                   "TCP port for clients (default: a free port, named by the ready line)")
      ->needs(to_tcp);
  AddChaosFlags(*command, options->flags);
  command->callback([options, &action] { action = [options] { return RunChaos(*options); }; });
}

}  // namespace furrow::cli
