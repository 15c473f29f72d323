// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace furrow::server {

// The service manager (systemd) that has started this process and wants to hear how it is.
class ServiceManager {
 public:
  [[nodiscard]] static bool IsPresent();

  // A listening TCP socket, which belongs to whoever takes it.
  struct Listener {
    int socket = -1;
    bool is_v6 = false;
    std::string address;  // numeric, without the port
  };
  // Those that the manager has opened and named, so that clients can connect while the daemon
  // starts or restarts (sd_listen_fds(3)). Absent: the daemon opens its own.
  struct Listeners {
    std::optional<Listener> tcp;   // FileDescriptorName=tcp
    std::optional<Listener> http;  // FileDescriptorName=http
  };
  // Descriptors that the daemon before this one has left with the manager, by Keep(). They belong
  // to whoever takes them.
  struct Kept {
    std::optional<Listener> tcp;
    std::optional<Listener> http;
    std::vector<int> udp;
    std::vector<int> connections;  // TCP
    int state = -1;                // a file in memory; -1: none
  };
  struct Passed {
    Listeners listeners;
    Kept kept;
  };
  // Once per process: the environment forgets them. Sockets with other names are closed, with a
  // warning.
  [[nodiscard]] static Passed TakeSockets();

  // How many descriptors the manager keeps while the daemon restarts (FileDescriptorStoreMax=, and
  // $FDSTORE as systemd 254 sets it). 0: none, or there is no manager.
  [[nodiscard]] static std::size_t StoreSize();

  // What the daemon leaves.
  static constexpr std::string_view kKeptTcp = "kept-tcp";
  static constexpr std::string_view kKeptHttp = "kept-http";
  static constexpr std::string_view kKeptUdp = "kept-udp";
  static constexpr std::string_view kKeptConnection = "kept-connection";
  static constexpr std::string_view kKeptState = "kept-state";
  // Leaves descriptors with the manager, which hands them to the next daemon in any order. The
  // caller still has to close its own. False: they could not be sent. Nobody learns which of them
  // the manager keeps: it closes those beyond StoreSize().
  [[nodiscard]] bool Keep(std::string_view name, std::span<const int> descriptors);
  // The manager gives up what is left under all names above.
  void ForgetAll();
  // Waits until the manager has read everything. It attributes messages to living processes only,
  // so a process that is about to end must wait. False: it has not, after `patience`.
  [[nodiscard]] bool Await(std::chrono::microseconds patience);

  // The daemon serves. `status`: one line for people, here and below.
  void Ready(const std::string& status);
  // The daemon is alive: feeds the watchdog of the unit. Call it about once per second.
  void Alive(const std::string& status);
  // The daemon has begun to read its configuration again; Ready() ends this.
  void Reloading();
  // The daemon has begun to shut down.
  void Stopping();

 private:
  void Send(const std::string& state, const std::string& status);

  std::string status_;  // the last one, which the manager still shows
};

}  // namespace furrow::server
