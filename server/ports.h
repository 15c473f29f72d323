// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>

#include <asio/io_context.hpp>

#include "base/status.h"
#include "server/config/config.h"
#include "server/core/metrics.h"
#include "server/core/time.h"
#include "server/credentials.h"
#include "server/machine/service_manager.h"
#include "server/net/mocap_inputs.h"
#include "server/net/tcp/tcp_server.h"
#include "server/net/udp/udp_port.h"
#include "server/restart/inheritance.h"
#include "server/restart/leave.h"
#include "server/saved/saved_state.h"
#include "server/session/hub.h"
#include "server/session/recording_tap.h"
#include "server/shares/waiting_bytes.h"

namespace furrow::server {

// The ports by which messages and poses arrive: TCP, UDP, and those of foreign wires. Belongs to
// the main thread.
class Ports {
 public:
  // Pointers are not null and outlive the ports, except as stated.
  struct Parts {
    asio::io_context* io = nullptr;
    Hub* hub = nullptr;
    Metrics* metrics = nullptr;
    WaitingBytes* waiting = nullptr;  // for clients of TCP
    Credentials* credentials = nullptr;
    RecordingTap* recording = nullptr;  // null: nothing is recorded
  };
  Ports(const Config& config, const Parts& parts);

  // Opens all ports; `listeners` takes the place of configured addresses, and sockets of the former
  // daemon that of new ones. Errors: kUnavailable. The message names the address and the port, or
  // says what keeps a socket of the service manager from being used.
  [[nodiscard]] Status Open(const Config& config, const ServiceManager::Listeners& listeners,
                            Inheritance* former);
  void Start();
  // Call it about every 10 ms.
  void Tick(Time now) { mocap_.Tick(now); }
  // Uses what a reload has changed; `former`: the configuration before.
  void Reload(const Config& config, const Config& former);
  // For a restart: Leave() ends the work on sockets, and joins the threads of other shards. False:
  // that takes a moment; let the event loop run and call it again. After that, Save() writes down
  // what the next daemon needs, and returns the sockets for it, of which `most` are connections.
  // Nothing may be received or sent afterwards except by Drain(). Stay() takes all peers but those
  // of secure sessions back, so that Drain() says goodbye to them.
  [[nodiscard]] bool Leave();
  [[nodiscard]] LeftSockets Save(SavedState* state, std::size_t most, Time now);
  void Stay();
  // How many sockets Save() returns besides connections.
  [[nodiscard]] std::size_t num_sockets() { return udp_.sockets().size() + (adopted_tcp_ ? 0 : 1); }
  // True if a connection has not sent all frames that may not be left out.
  [[nodiscard]] bool OwesFrames() const { return tcp_.OwesFrames(); }
  // Goes on with the peers of the former daemon.
  [[nodiscard]] Hub::ResumedPeers Resume(const SavedState& state, Inheritance* former, Time now);

  // Ends the input and joins the threads of other shards: from here on only the calling thread uses
  // the hub. Connections close once their queues are empty.
  void Drain();
  [[nodiscard]] bool IsSending() const { return tcp_.num_sessions() > 0; }
  // Clients that have not read until now lose what is left.
  void CloseAll() { tcp_.CloseAll(); }

  [[nodiscard]] HostPort tcp() const { return tcp_.address(); }
  [[nodiscard]] std::uint16_t udp() const { return udp_.port(); }
  [[nodiscard]] const MocapInputs& mocap() const { return mocap_; }
  // MocapInputs::Give().
  [[nodiscard]] Status Give(bool vmc, const std::string& sender, Time now) {
    return mocap_.Give(vmc, sender, now);
  }
  // A socket of the service manager listens to other computers.
  [[nodiscard]] bool adopted_network() const { return adopted_network_; }

 private:
  Status CheckListener(const ServiceManager::Listener& listener, bool is_open);

  const Parts parts_;
  TcpServer tcp_;
  UdpPort udp_;
  MocapInputs mocap_;
  bool adopted_network_ = false;
  bool adopted_tcp_ = false;  // the listening socket is the service manager's
};

}  // namespace furrow::server
