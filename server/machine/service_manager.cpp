// SPDX-License-Identifier: Apache-2.0
#include "server/machine/service_manager.h"

#include <algorithm>
#include <cstddef>
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

// False: the place is taken, or this is not a listening TCP socket.
bool Fill(std::optional<ServiceManager::Listener>& place, int socket) {
  if (place) return false;
  place = ListenerOf(socket);
  return place.has_value();
}

// False: nobody uses a descriptor of this name and kind.
bool Sort(std::string_view name, int descriptor, ServiceManager::Passed& passed) {
  ServiceManager::Kept& kept = passed.kept;
  if (name == "tcp") return Fill(passed.listeners.tcp, descriptor);
  if (name == "http") return Fill(passed.listeners.http, descriptor);
  if (name == ServiceManager::kKeptTcp) return Fill(kept.tcp, descriptor);
  if (name == ServiceManager::kKeptHttp) return Fill(kept.http, descriptor);
  if (name == ServiceManager::kKeptUdp &&
      sd_is_socket(descriptor, AF_UNSPEC, SOCK_DGRAM, /*listening=*/-1) > 0) {
    kept.udp.push_back(descriptor);
    return true;
  }
  if (name == ServiceManager::kKeptConnection &&
      sd_is_socket(descriptor, AF_UNSPEC, SOCK_STREAM, /*listening=*/0) > 0) {
    kept.connections.push_back(descriptor);
    return true;
  }
  if (name == ServiceManager::kKeptState && kept.state < 0) {
    kept.state = descriptor;
    return true;
  }
  return false;
}

}  // namespace

bool ServiceManager::IsPresent() { return std::getenv("NOTIFY_SOCKET") != nullptr; }

std::size_t ServiceManager::StoreSize() {
  const char* const most = std::getenv("FDSTORE");
  if (!IsPresent() || most == nullptr) return 0;
  return static_cast<std::size_t>(std::max(std::atoi(most), 0));
}

ServiceManager::Passed ServiceManager::TakeSockets() {
  Passed passed;
  char** names = nullptr;
  const int count = sd_listen_fds_with_names(/*unset_environment=*/1, &names);
  for (int i = 0; i < count; ++i) {
    const int descriptor = SD_LISTEN_FDS_START + i;
    const std::string_view name = names[i];
    if (!Sort(name, descriptor, passed)) {
      spdlog::warn(
          "the service manager passes socket '{}', which is not used: the listening TCP sockets "
          "'tcp' and 'http' are",
          name);
      close(descriptor);
    }
    std::free(names[i]);
  }
  std::free(names);
  return passed;
}

bool ServiceManager::Keep(std::string_view name, std::span<const int> descriptors) {
  // The kernel passes at most 253 descriptors at once (SCM_MAX_FD).
  constexpr std::size_t kAtOnce = 128;
  const std::string state = "FDSTORE=1\nFDNAME=" + std::string(name);
  while (!descriptors.empty()) {
    const auto some = descriptors.first(std::min(kAtOnce, descriptors.size()));
    descriptors = descriptors.subspan(some.size());
    const int sent = sd_pid_notify_with_fds(0, /*unset_environment=*/0, state.c_str(), some.data(),
                                            static_cast<unsigned>(some.size()));
    if (sent <= 0) return false;
  }
  return true;
}

void ServiceManager::ForgetAll() {
  for (const std::string_view name : {kKeptState, kKeptTcp, kKeptHttp, kKeptUdp, kKeptConnection}) {
    const std::string state = "FDSTOREREMOVE=1\nFDNAME=" + std::string(name);
    (void)sd_notify(/*unset_environment=*/0, state.c_str());
  }
}

bool ServiceManager::Await(std::chrono::microseconds patience) {
  return sd_notify_barrier(/*unset_environment=*/0, static_cast<std::uint64_t>(patience.count())) >
         0;
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
