// SPDX-License-Identifier: Apache-2.0
#include "server/machine/service_manager.h"

#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <string>
#include <string_view>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

namespace furrow::server {

namespace {

std::optional<ServiceManager::Listener> ListenerOf(int socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  if (sd_is_socket(socket, AF_UNSPEC, SOCK_STREAM, /*listening=*/1) <= 0) return std::nullopt;
  if (getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0) return std::nullopt;
  const bool is_v6 = address.ss_family == AF_INET6;
  if (!is_v6 && address.ss_family != AF_INET) return std::nullopt;
  const void* const bytes =
      is_v6 ? static_cast<const void*>(&reinterpret_cast<const sockaddr_in6&>(address).sin6_addr)
            : &reinterpret_cast<const sockaddr_in&>(address).sin_addr;
  char text[INET6_ADDRSTRLEN] = {};
  if (inet_ntop(address.ss_family, bytes, text, sizeof(text)) == nullptr) return std::nullopt;
  return ServiceManager::Listener{socket, is_v6, text};
}

}  // namespace

bool ServiceManager::IsPresent() { return std::getenv("NOTIFY_SOCKET") != nullptr; }

ServiceManager::Listeners ServiceManager::TakeListeners() {
  Listeners listeners;
  char** names = nullptr;
  const int count = sd_listen_fds_with_names(/*unset_environment=*/1, &names);
  for (int i = 0; i < count; ++i) {
    const int socket = SD_LISTEN_FDS_START + i;
    const std::string_view name = names[i];
    std::optional<Listener>* const place = name == "tcp"    ? &listeners.tcp
                                           : name == "http" ? &listeners.http
                                                            : nullptr;
    std::optional<Listener> listener = ListenerOf(socket);
    if (place != nullptr && !*place && listener) {
      *place = std::move(listener);
    } else {
      spdlog::warn(
          "the service manager passes socket '{}', which is not used: the listening TCP sockets "
          "'tcp' and 'http' are",
          name);
      close(socket);
    }
    std::free(names[i]);
  }
  std::free(names);
  return listeners;
}

void ServiceManager::Ready(const std::string& status) { Send("READY=1\n", status); }

void ServiceManager::Alive(const std::string& status) { Send("WATCHDOG=1\n", status); }

// systemd takes READY=1 for the end of this reload if it knows when the reload began
// (sd_notify(3)).
void ServiceManager::Reloading() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  const std::int64_t microseconds = std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1'000;
  Send("RELOADING=1\nMONOTONIC_USEC=" + std::to_string(microseconds) + "\n",
       "reading the configuration again");
}

void ServiceManager::Stopping() { Send("STOPPING=1\n", "shutting down"); }

// Errors are ignored: the daemon serves without the manager, too.
void ServiceManager::Send(const std::string& state, const std::string& status) {
  const bool is_new = status != std::exchange(status_, status);
  (void)sd_notify(/*unset_environment=*/0, (state + (is_new ? "STATUS=" + status : "")).c_str());
}

}  // namespace furrow::server
