// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

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
  // Once per process: the environment forgets them. Sockets with other names are closed, with a
  // warning.
  [[nodiscard]] static Listeners TakeListeners();

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
