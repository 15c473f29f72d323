// SPDX-License-Identifier: Apache-2.0
#include "client/load/compare/echo_server.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include <netinet/in.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/process/descriptor.h"

namespace furrow::load {
namespace {

Status SystemError(const char* what) {
  return {StatusCode::kIo, std::string(what) + ": " + std::strerror(errno), "echo server"};
}

// Runs in the child until it is killed, with system calls alone.
[[noreturn]] void Serve(int socket) {
  std::array<char, 2048> buffer{};
  for (;;) {
    sockaddr_storage from{};
    socklen_t size = sizeof(from);
    const ssize_t bytes = recvfrom(socket, buffer.data(), buffer.size(), 0,
                                   reinterpret_cast<sockaddr*>(&from), &size);
    if (bytes < 0) continue;  // an earlier answer was refused
    (void)sendto(socket, buffer.data(), static_cast<std::size_t>(bytes), 0,
                 reinterpret_cast<const sockaddr*>(&from), size);
  }
}

}  // namespace

Result<EchoServer> EchoServer::Start(std::optional<int> same_cores_as) {
  Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  auto* const plain = reinterpret_cast<sockaddr*>(&address);
  if (socket.get() < 0 || bind(socket.get(), plain, size) != 0 ||
      getsockname(socket.get(), plain, &size) != 0) {
    return SystemError("cannot open a socket");
  }
  const int bytes = 4 << 20;
  setsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &bytes, sizeof(bytes));
  setsockopt(socket.get(), SOL_SOCKET, SO_SNDBUF, &bytes, sizeof(bytes));
  // The socket is bound before fork(), so the port is known and datagrams queue until the child
  // reads.
  const int parent = getpid();
  const int pid = fork();
  if (pid < 0) return SystemError("cannot start a process");
  if (pid == 0) {
    // The child must not outlive a load tester that crashes.
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    // The parent died before prctl(), so its signal will not come. _exit() runs no handlers of the
    // parent.
    if (getppid() != parent) _exit(0);
    std::signal(SIGINT, SIG_IGN);  // Ctrl-C reaches all processes; the parent ends this one
    cpu_set_t cores;
    // Both servers get the same cores, or the comparison would measure the cores.
    if (same_cores_as && sched_getaffinity(*same_cores_as, sizeof(cores), &cores) == 0)
      sched_setaffinity(0, sizeof(cores), &cores);
    Serve(socket.get());
  }
  return EchoServer(pid, ntohs(address.sin_port));
}

EchoServer::EchoServer(EchoServer&& other) noexcept
    : pid_(std::exchange(other.pid_, 0)), port_(other.port_) {}

EchoServer::~EchoServer() {
  if (pid_ <= 0) return;
  kill(pid_, SIGKILL);
  // Without the wait the child would stay as a zombie.
  waitpid(pid_, nullptr, 0);
}

}  // namespace furrow::load
