// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include "tests/temporary_folder.h"

namespace furrow::testing_net {

// The socket of a service manager, which receives what the daemon says (sd_notify(3)).
class NotifySocket {
 public:
  NotifySocket() : socket_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path().copy(address.sun_path, sizeof(address.sun_path) - 1);
    EXPECT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
    const timeval deadline{20, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &deadline, sizeof(deadline));
  }
  ~NotifySocket() { close(socket_); }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  [[nodiscard]] std::string path() const { return (folder_.path() / "notify").string(); }
  // The next message; empty after 20 s without one.
  [[nodiscard]] std::string Next() const {
    char text[4096];
    const ssize_t size = recv(socket_, text, sizeof(text), 0);
    return size > 0 ? std::string(text, static_cast<std::size_t>(size)) : std::string();
  }
  // The next message that does not begin with `left_out`; empty after 60 that do, which come about
  // once per second.
  [[nodiscard]] std::string NextBut(const std::string& left_out) const {
    for (int i = 0; i < 60; ++i) {
      std::string text = Next();
      if (!text.starts_with(left_out)) return text;
    }
    return {};
  }

 private:
  TemporaryFolder folder_;
  int socket_;
};

}  // namespace furrow::testing_net
