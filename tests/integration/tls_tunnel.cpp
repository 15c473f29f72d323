// SPDX-License-Identifier: Apache-2.0
#include "tls_tunnel.h"

#include <array>
#include <csignal>
#include <utility>

#include <openssl/ssl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "raw_client.h"

namespace furrow::testing_net {

TlsTunnel::TlsTunnel(std::uint16_t port, SSL_CTX* context, const std::string& protocols)
    : tcp_(ConnectSocket(SOCK_STREAM, port)), ssl_(SSL_new(context), &SSL_free) {
  // OpenSSL writes without MSG_NOSIGNAL.
  std::signal(SIGPIPE, SIG_IGN);
  SSL_set_alpn_protos(ssl_.get(), reinterpret_cast<const unsigned char*>(protocols.data()),
                      static_cast<unsigned int>(protocols.size()));
  SSL_set_fd(ssl_.get(), tcp_);
  if (SSL_connect(ssl_.get()) != 1) return;
  serial_ = ASN1_INTEGER_get(X509_get0_serialNumber(SSL_get0_peer_certificate(ssl_.get())));
  std::array<int, 2> pair{};
  if (socketpair(AF_UNIX, SOCK_STREAM, 0, pair.data()) != 0) return;
  inner_ = pair[0];
  outer_ = pair[1];
  thread_ = std::thread([this] { Carry(); });
}

TlsTunnel::~TlsTunnel() {
  // Ends the thread, which waits for one of both.
  shutdown(tcp_, SHUT_RDWR);
  if (thread_.joinable()) thread_.join();
  for (const int socket : {tcp_, inner_, outer_}) {
    if (socket >= 0) close(socket);
  }
}

int TlsTunnel::TakeSocket() { return std::exchange(outer_, -1); }

// Only this thread uses the SSL object from here on. What one end closes is closed at the other.
void TlsTunnel::Carry() {
  std::array<char, 16 * 1024> buffer;
  std::array<pollfd, 2> ends{pollfd{tcp_, POLLIN, 0}, pollfd{inner_, POLLIN, 0}};
  while (true) {
    // Bytes that OpenSSL has read already do not wake poll().
    if (SSL_pending(ssl_.get()) == 0 && poll(ends.data(), ends.size(), -1) <= 0) break;
    if (SSL_pending(ssl_.get()) > 0 || ends[0].revents != 0) {
      const int size = SSL_read(ssl_.get(), buffer.data(), static_cast<int>(buffer.size()));
      if (size <= 0 ||
          send(inner_, buffer.data(), static_cast<std::size_t>(size), MSG_NOSIGNAL) <= 0)
        break;
    }
    if (ends[1].revents != 0) {
      const ssize_t size = recv(inner_, buffer.data(), buffer.size(), MSG_DONTWAIT);
      if (size <= 0) break;
      if (SSL_write(ssl_.get(), buffer.data(), static_cast<int>(size)) <= 0) break;
    }
    ends[1].revents = 0;
  }
  shutdown(inner_, SHUT_RDWR);
  SSL_shutdown(ssl_.get());
  shutdown(tcp_, SHUT_RDWR);
}

}  // namespace furrow::testing_net
