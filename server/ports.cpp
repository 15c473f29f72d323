// SPDX-License-Identifier: Apache-2.0
#include "server/ports.h"

#include <chrono>

#include <asio/ip/address.hpp>
#include <spdlog/spdlog.h>

#include "server/core/network_address.h"

namespace furrow::server {
namespace {

// The port is useless for phones otherwise, and nothing on them says why.
void WarnAboutLoopback(const std::string& bind) {
  spdlog::warn(
      "--livelink-face listens on {} only, so no phone can reach it: --bind 0.0.0.0 --open opens "
      "the daemon to the network (docs/SECURITY.md)",
      bind);
}

}  // namespace

Ports::Ports(const Config& config, const Parts& parts)
    : parts_(parts),
      tcp_(*parts.io, config.limits, parts.hub, parts.metrics, parts.waiting,
           &parts.credentials->tls()),
      udp_(*parts.io, config.threads, config.limits, parts.hub, parts.metrics, parts.recording,
           parts.credentials->secure(), parts.credentials->gate().required()) {
  udp_.SetBusyPoll(std::chrono::microseconds(config.busy_poll_us));
}

// The configuration does not know where the sockets of the service manager listen, and an open
// daemon must not be on the network without anybody having said so.
Status Ports::CheckListener(const ServiceManager::Listener& listener, bool is_open) {
  if (IsLoopback(listener.address)) return {};
  adopted_network_ = true;
  if (parts_.credentials->gate().required() || is_open) return {};
  return Status(StatusCode::kUnavailable,
                "a socket of the service manager listens on " + listener.address +
                    ", where everybody could publish and change settings",
                "", "set --security required, or --open");
}

Status Ports::Open(const Config& config, const ServiceManager::Listeners& listeners,
                   Inheritance* former) {
  // ValidateConfig() has checked the address, so this does not throw.
  const auto address = asio::ip::make_address(config.bind);
  for (const auto& listener : {listeners.tcp, listeners.http}) {
    if (listener) FURROW_RETURN_IF_ERROR(CheckListener(*listener, config.open));
  }
  adopted_tcp_ = listeners.tcp.has_value();
  const auto tcp = adopted_tcp_ ? listeners.tcp : former->TakeTcp(config.bind, config.tcp);
  const auto udp = former->TakeUdp(config.bind, config.udp, config.threads);
  FURROW_RETURN_IF_ERROR(tcp ? tcp_.Adopt(*tcp) : tcp_.Open({address, config.tcp}));
  FURROW_RETURN_IF_ERROR(udp.empty() ? udp_.Open({address, config.udp}) : udp_.Adopt(udp));
  FURROW_RETURN_IF_ERROR(mocap_.Open({.bind = config.bind,
                                      .vmc = config.vmc,
                                      .livelink_face = config.livelink_face,
                                      .allow = config.mocap_allow},
                                     *parts_.io, parts_.hub, parts_.metrics));
  if (mocap_.livelink_face_port() && IsLoopback(config.bind)) WarnAboutLoopback(config.bind);
  return {};
}

void Ports::Start() {
  tcp_.Start();
  udp_.Start();
  mocap_.Start();
}

void Ports::Reload(const Config& config, const Config& former) {
  tcp_.SetLimits(config.limits);
  // A new gate lets the holder of a port go.
  if (config.mocap_allow != former.mocap_allow) mocap_.SetAllowed(config.mocap_allow);
}

bool Ports::Leave() {
  udp_.Leave();
  return tcp_.Leave();
}

void Ports::Stay() {
  parts_.hub->KeepPeers();
  tcp_.Stay();
}

LeftSockets Ports::Save(SavedState* state, std::size_t most, Time now) {
  // The last frames come from poses that have waited. They leave, or wait in their connections.
  state->subjects = parts_.hub->SaveSubjects(now);
  LeftSockets sockets;
  sockets.connections = tcp_.Save(state, most);
  udp_.Save(state);
  sockets.udp = udp_.sockets();
  if (!adopted_tcp_) sockets.tcp = tcp_.socket();
  return sockets;
}

Hub::ResumedPeers Ports::Resume(const SavedState& state, Inheritance* former, Time now) {
  Hub::ResumedPeers peers;
  udp_.Resume(state, &peers, now);
  for (const SavedConnection& saved : state.connections) {
    const int socket = former->TakeConnection(saved.socket);
    if (socket >= 0) tcp_.Resume(saved, socket, &peers);
  }
  return peers;
}

void Ports::Drain() {
  udp_.Close();
  mocap_.Close();
  tcp_.Drain();
}

}  // namespace furrow::server
