// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include <openssl/types.h>

namespace furrow::testing_net {

// A TLS connection to a daemon on this computer, as a plain socket for the clients of these tests.
// A thread carries the bytes.
class TlsTunnel {
 public:
  // `protocols`: as TLS sends them (ALPN), each with its length in front; empty: none.
  TlsTunnel(std::uint16_t port, SSL_CTX* context,
            const std::string& protocols =
                "\x08"
                "furrow/1");
  ~TlsTunnel();
  TlsTunnel(const TlsTunnel&) = delete;
  TlsTunnel& operator=(const TlsTunnel&) = delete;

  // False: the daemon refused the handshake.
  [[nodiscard]] bool connected() const { return thread_.joinable(); }
  // The plain end, which the caller owns. Once only.
  [[nodiscard]] int TakeSocket();
  // The serial number of the daemon's certificate.
  [[nodiscard]] long serial() const { return serial_; }

 private:
  void Carry();

  int tcp_ = -1;
  int inner_ = -1;  // our end of the pair of sockets
  int outer_ = -1;  // the caller's end
  long serial_ = 0;
  std::unique_ptr<SSL, void (*)(SSL*)> ssl_;
  std::thread thread_;
};

}  // namespace furrow::testing_net
